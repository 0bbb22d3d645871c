"""Functions used by all rules: the checked configuration, files and parameters of jobs."""

import gc
import json
import os
import subprocess
import sys
from functools import cache, partial
from pathlib import Path

from snakemake.exceptions import WorkflowError

from chatterjee1995.workflow import selection
from chatterjee1995.workflow.configuration import check_configuration, without_left_out
from chatterjee1995.workflow.registry import CHAPTERS, PAPER, STAGES
from chatterjee1995.workflow.registry.clearance import study_chunk
from chatterjee1995.workflow.sources import compiled_kernels
from impact_damper.command.yaml_files import ConfigurationError, check_file
from impact_damper.kernel.sources import module_file, sources

# Planning makes many small objects, none of which becomes garbage. Collecting garbage less often
# than by default saves a fifteenth of the time of a dry run.
gc.set_threshold(100_000)

ROOT = Path(workflow.basedir)
PACKAGES = ROOT / "src"
ENVIRONMENT = str(ROOT / "workflow/envs/impact-damper.yaml")
# Jobs that need compiled kernels (functions compiled by numba) wait for this marker file. With
# `ancient` a new date of the file reruns no job.
KERNELS = ancient("<results>/kernels.compiled")


# Whether the option `--cache` is given. Rules are cacheable only with this option, because without
# it Snakemake prints a line for each cacheable rule.
SHARED = workflow.workflow_settings.cache is not None


wildcard_constraints:
    name="[A-Za-z0-9_]+",


def checked(config):
    """Return the configuration with its keys sorted, or raise an error that lists its problems.

    Only the main process checks, since jobs run in other processes and the check takes half a second.
    """
    config = without_left_out(config)
    try:
        if workflow.is_main_process:
            for path in workflow.configfiles:
                check_file(path)
            check_configuration(config)
    except ConfigurationError as error:
        raise WorkflowError(f"The configuration cannot be run.\n{error}") from None
    # Snakemake compares parameters as text, in which the order of keys counts.
    return json.loads(json.dumps(config, sort_keys=True))


config = checked(config)


def local(path):
    """Return a path relative to the working directory, so that a checkout can be moved."""
    return os.path.relpath(path)


@cache
def code(script, *modules):
    """Return the source files of a job: script, modules, and the package's modules they import.

    The lock file stands for the versions of all other packages.
    """
    paths = {ROOT / "workflow/scripts" / f"{script}.py", *map(module_file, modules)}
    return sorted(map(local, sources(*paths) | {ROOT / "requirements.lock"}))


def data(stage, names=None):
    """Return the datasets of a stage, for all its entries in the configuration or for `names`."""
    names = selection.entries(config, stage) if names is None else names
    return [f"<results>/{stage}/{name}.nc" for name in names]


def data_by_stage(names):
    """Return the datasets of several stages as keyword arguments of `input`.

    `names` holds the names of the entries, keyed by stage.
    """
    return {stage: data(stage, chosen) for stage, chosen in names.items()}


def read_by(stage):
    """Return an input function of Snakemake: the datasets of earlier stages that a job reads."""

    def files(wildcards):
        chosen = selection.read_by(config, stage, wildcards.name)
        return [path for each, names in chosen.items() for path in data(each, names)]

    return files


def parameters(stage, function=None):
    """Return the parameters of a stage's jobs, each as {key: value}.

    Snakemake compares only the set of values, so that without the keys two parameters could be
    exchanged unnoticed. One parameter for each key lets a dry run show which parameter changed. The
    name of the entry is a parameter too, because the dataset holds it: with `--cache` another entry
    with equal values must not get the same file.
    """
    function = function or STAGES[stage].parameters

    def name(wildcards):
        return {"name": "/".join(wildcards)}

    def value(key, wildcards):
        return {key: function(config, *wildcards)[key]}

    names = selection.entries(config, stage)
    keys = {key for name in names for key in STAGES[stage].parameters(config, name)}
    return {"name": name} | {key: partial(value, key) for key in sorted(keys)}


def parameters_of_all(stage):
    """Return the parameters of a stage with one job for all entries, keyed by entry."""
    return {
        name: {name: STAGES[stage].parameters(config, name)}
        for name in selection.entries(config, stage)
    }


def write_provenance():
    """Write versions, commit and computer into `provenance.json`."""
    from chatterjee1995.workflow.provenance import provenance

    path = Path(config["results"]) / "provenance.json"
    part = path.with_name(f"{path.name}.part-{os.getpid()}")
    part.write_text(json.dumps(provenance(config, ROOT), indent=2) + "\n")
    os.replace(part, path)


def chunks_of_study(wildcards):
    """Return the files of the chunks of a study; none if one job computes the study."""
    count = config["chunks"]
    numbers = range(1, count + 1) if count > 1 else []
    return [f"<results>/study_chunks/{wildcards.name}/{k}-of-{count}.nc" for k in numbers]


def chapter_parameters(chapter):
    """Return the parameters of the job of a chapter, each as {key: value}."""
    values = selection.chapter_values(config, chapter)
    return {key: {key: value} for key, value in values.items()}


def figure_files(chapter):
    """Return the files of the figures of a chapter, with their captions."""
    names = selection.figures_of(config, chapter)
    return expand("<results>/figures/{name}.{kind}", name=names, kind=["pdf", "png", "rst"])


def table_files(chapter):
    """Return the files of the tables of a chapter, with their captions."""
    names = [table.name for table in CHAPTERS[chapter].TABLES]
    return expand("<results>/tables/{name}.{kind}", name=names, kind=["csv", "md", "rst"])


def target_files(stage):
    """Return the files that the target of a stage makes.

    These are its datasets and, if the stage is not part of the paper, also its pages, and the
    figures and tables of its chapter.
    """
    if STAGES[stage].paper:
        return data(stage)
    chapter = next(name for name, each in CHAPTERS.items() if STAGES[stage] in each.STAGES)
    shown = [*figure_files(chapter), *table_files(chapter)]
    return [*data(stage), *shown, *page_files(stage)]


def page_files(stage):
    """Return the files of the pages of a stage's entries; none for a stage without pages."""
    names = selection.entries(config, stage) if STAGES[stage].page else []
    files = [f"{figure}.png" for figure in STAGES[stage].page]
    return expand(
        f"<results>/{stage}/{{name}}/{{file}}", name=names, file=["index.html", "report.md", *files]
    )


def chapter_files(chapter):
    """Return the outputs of the job of a chapter: figures, tables and captions."""
    figures = selection.figures_of(config, chapter)
    tables = [table.name for table in CHAPTERS[chapter].TABLES]
    return [
        *expand("<results>/figures/{name}.{kind}", name=figures, kind=["pdf", "rst"]),
        *expand("<results>/tables/{name}.{kind}", name=tables, kind=["md", "rst"]),
        *[in_report(chapter, "figures", name, "png") for name in figures],
        *[in_report(chapter, "tables", name, "csv") for name in tables],
    ]


def in_report(chapter, folder, name, kind):
    """Return a file that Snakemake's report shows, with the caption by the job of the chapter."""
    return report(
        f"<results>/{folder}/{name}.{kind}",
        caption=os.path.abspath(f"{config['results']}/{folder}/{name}.rst"),
        category=CHAPTERS[chapter].TITLE,
        labels={"kind": folder.removesuffix("s"), "name": name},
    )


def compile_again():
    """Compile the kernels if their sources were edited since the marker file was written.

    The marker file holds a digest of the sources.
    """
    marker, now = Path(config["results"]) / "kernels.compiled", compiled_kernels(config)
    if not marker.exists() or marker.read_bytes() == now.encode():
        return
    logger.info("Compiling the kernels again: they were edited")
    program = [sys.executable, "-m", "chatterjee1995.workflow.compile_kernels"]
    arguments = json.dumps([workflow.cores or 1, config["comparison"]["orders"]])
    if subprocess.run([*program, arguments]).returncode:
        raise WorkflowError("The kernels cannot be compiled: see the error above.")
    marker.write_text(now)
