"""The paper, end to end: `snakemake --cores 2`; the data of a stage: `snakemake all_response`."""

from snakemake.utils import min_version

min_version("9.27")


configfile: workflow.source_path("config/config.yaml")


include: "workflow/rules/common.smk"


pathvars:
    results=settings.results,
    logs=f"{settings.results}/logs",


report: "workflow/report/workflow.rst"


include: "workflow/rules/checks.smk"
include: "workflow/rules/kernels.smk"
include: "workflow/rules/stages.smk"
include: "workflow/rules/report.smk"


onstart:
    check_writable(Path(settings.results))
    compile_again()


onsuccess:
    write_provenance()


# For each stage a target that makes all data of the stage: `all_response`, `all_motion`, ...
for stage in STAGES:

    rule:
        name:
            f"all_{stage}"
        input:
            target_files(stage),


rule all:
    default_target: True
    input:
        [data(stage) for stage in STAGES if STAGES[stage].paper],
        rules.figures.input,
        rules.tables.input,
    message:
        "The paper"


# The paper, and the stages that are not part of the paper.
rule everything:
    input:
        rules.all.input,
        [target_files(stage) for stage in STAGES if not STAGES[stage].paper],
    message:
        "Everything"
