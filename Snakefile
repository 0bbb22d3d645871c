"""The paper, end to end: `snakemake --cores 2`; a stage of it: `snakemake --cores 2 design`."""

from snakemake.utils import min_version

min_version("9.27")


configfile: workflow.source_path("config/config.yaml")


include: "workflow/rules/common.smk"


pathvars:
    results=config["results"],
    logs=f"{config['results']}/logs",
    benchmarks=f"{config['results']}/timings",


report: "workflow/report/workflow.rst"


include: "workflow/rules/checks.smk"
include: "workflow/rules/jobs.smk"
include: "workflow/rules/further_jobs.smk"
include: "workflow/rules/figure_jobs.smk"
include: "workflow/rules/kernels.smk"
include: "workflow/rules/design.smk"
include: "workflow/rules/free.smk"
include: "workflow/rules/response.smk"
include: "workflow/rules/branches.smk"
include: "workflow/rules/optimum.smk"
include: "workflow/rules/subharmonic.smk"
include: "workflow/rules/migration.smk"
include: "workflow/rules/release_scan.smk"
include: "workflow/rules/contact_model.smk"
include: "workflow/rules/rigid_limit.smk"
include: "workflow/rules/design_rules.smk"
include: "workflow/rules/harmonics.smk"
include: "workflow/rules/missed_contacts.smk"
include: "workflow/rules/stable_steps.smk"
include: "workflow/rules/verdicts.smk"
include: "workflow/rules/balance_map.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/studies.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/tables.smk"


onstart:
    check_writable(Path(config["results"]))
    if workflow.is_main_process and workflow.local_exec:
        before_commands(start_warm_process())
        # Snakemake's own limit on jobs a second is for queues. To keep it, all that is ready is
        # looked at once a second for each job that has ended: in the end that took a core.
        limit = workflow.scheduling_settings.max_jobs_per_timespan
        if limit and (limit.max_jobs, limit.timespan) == (100, 1):
            workflow.scheduler.job_rate_limiter = None


onsuccess:
    write_provenance()


rule all:
    default_target: True
    input:
        rules.design.input,
        rules.free.input,
        rules.response.input,
        rules.branches.input,
        rules.optimum.input,
        rules.subharmonic.input,
        rules.migration.input,
        rules.release_scan.input,
        rules.contact_model.input,
        rules.rigid_limit.input,
        rules.design_rules.input,
        rules.harmonics.input,
        rules.missed_contacts.input,
        rules.stable_steps.input,
        rules.verdicts.input,
        rules.balance_map.input,
        rules.accuracy.input,
        rules.studies.input,
        rules.figures.input,
        rules.tables.input,
    message:
        "Everything"
