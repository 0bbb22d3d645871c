"""Functions used by all rules: the checked configuration, files and parameters of jobs."""

import gc
import hashlib
import json
import os
import subprocess
import sys
from functools import cache, partial
from pathlib import Path

from snakemake.exceptions import WorkflowError

from chatterjee1995.sections.configuration import configuration
from chatterjee1995.sections.registry import CHAPTERS, PAPER, STAGES, TABLES
from chatterjee1995.sections import selection
from chatterjee1995.workflow.kernels import compiled_kernels
from impact_damper.command.section import ConfigurationError, check_file
from impact_damper.kernel.sources import KERNEL, kernel_digest, module_file, sources

# Planning makes many small objects, and none becomes garbage: fewer collections save time.
gc.set_threshold(100_000)

ROOT = Path(str(workflow.current_basedir)).parents[1]
ENVIRONMENT = str(ROOT / "workflow/envs/impact-damper.yaml")
# Jobs that need compiled kernels (functions compiled by numba) wait for this marker file. With
# `ancient` a new date of the file reruns no job.
KERNELS = ancient("<results>/kernels.compiled")
# Rules are cacheable only with the option `--cache`: Snakemake prints a line for a cacheable rule.
SHARED = workflow.workflow_settings.cache is not None


wildcard_constraints:
    name="[A-Za-z0-9_]+",


def checked(given):
    """Return the configuration as an object, or raise an error that lists its problems.

    Only the main process checks everything: other processes run jobs that the main process has
    planned. The configuration of the last complete run into this folder is not checked again.
    """
    main = workflow.is_main_process
    try:
        for path in workflow.configfiles if main else ():
            check_file(path)
        return configuration(given, trusted=not main or last_checked(given) == digest(given))
    except ConfigurationError as error:
        raise WorkflowError(f"The configuration cannot be run.\n{error}") from None


def digest(given):
    """Return a digest of a configuration and of the sources that check it."""
    code = kernel_digest(module_file("chatterjee1995.sections.configuration"))
    return hashlib.sha256(f"{code} {given!r}".encode()).hexdigest()


def last_checked(given):
    """Return the digest that the last complete run stored, or None without such a run."""
    try:
        return json.loads((Path(given["results"]) / "provenance.json").read_text())["checked"]
    except (OSError, TypeError, KeyError, ValueError):
        return None


# The checked configuration, from which the rules are made.
settings = checked(config)


def local(path):
    """Return a path relative to the working directory, so that a checkout can be moved."""
    return os.path.relpath(path)


@cache
def code(script, *modules):
    """Return the source files of a job: script, modules, and all modules that these import.

    Texts and templates beside these modules count too, and the lock file stands for the versions of
    all other packages.
    """
    paths = {ROOT / "workflow/scripts" / f"{script}.py", module_file("chatterjee1995.workflow.job")}
    # The first import of a module of the paper registers the paper's variables.
    paper = {"chatterjee1995"} if any(name.startswith("chatterjee1995") for name in modules) else ()
    paths.update(map(module_file, (*modules, *paper)))
    found = sources(*paths) | {ROOT / "requirements.lock"}
    texts = [path for folder in {path.parent for path in found} for path in beside(folder)]
    return sorted(map(local, found.union(texts)))


@cache
def beside(folder):
    """Return the texts and templates that the modules of a folder read."""
    kinds = ("*.yaml", "*.md", "templates/*.jinja") if (folder / "__init__.py").exists() else ()
    return [path for kind in kinds for path in folder.glob(kind)]


def data(stage, names=None):
    """Return the datasets of a stage, for all its entries in the configuration or for `names`."""
    names = selection.entries(settings, stage) if names is None else names
    return [f"<results>/{stage}/{name}.nc" for name in names]


def inputs(stage):
    """Return the inputs of a stage's rule besides its code; KERNELS if the stage uses kernels."""
    files = {key: local(ROOT / path) for key, path in stage.files.items()}
    files |= {key: partial(read_by, stage.name, key) for key in stage.reads}
    function = module_file(stage.function.split(":")[0])
    compiled = any(KERNEL in path.parents for path in sources(function))
    return files | ({"kernels": KERNELS} if compiled else {})


def read_by(stage, key, wildcards):
    """Return the datasets of earlier stages that a job reads as the argument `key`."""
    stages = selection.read_by(settings, stage, wildcards.name)[key]
    return [path for each in stages for path in data(each, [wildcards.name])]


def parameters(stage):
    """Return the parameters of a stage's jobs, each as {key: value}.

    Snakemake compares only the set of values, so that without the keys two parameters could be
    exchanged unnoticed. One parameter for each key lets a dry run show which parameter changed. The
    name of the entry is a parameter too, because the dataset holds it: with `--cache` another entry
    with equal values must not get the same file.
    """
    jobs = {each: selection.job(settings, stage.name, each) for each in data_names(stage.name)}
    function = {"function": {"function": stage.function}}
    if stage.together:
        return function | {f"entry_{each}": {f"entry_{each}": job} for each, job in jobs.items()}
    keys = sorted({key for job in jobs.values() for key in job})
    return function | {"name": named} | {key: partial(value, jobs, key) for key in keys}


def data_names(stage):
    """Return the names of the entries of a stage."""
    return selection.entries(settings, stage)


def named(wildcards):
    """Return the name of a job's entry as a parameter."""
    return {"name": "/".join(wildcards)}


def value(jobs, key, wildcards):
    """Return one parameter of the job of an entry."""
    return {key: jobs[wildcards.name][key]}


def parameters_of_chunks():
    """Return the parameters of the jobs that compute chunks of studies, each as {key: value}."""
    function = STAGES["studies"].function
    studies = settings.studies
    keys = next(iter(studies.values())).chunk(settings, "1-of-1")

    def value(key, wildcards):
        return {key: studies[wildcards.name].chunk(settings, wildcards.chunk)[key]}

    return {
        "function": {"function": function},
        "name": named,
        **{key: partial(value, key) for key in sorted(keys)},
    }


def chunks_of_study(wildcards):
    """Return the files of the chunks of a study."""
    count = settings.chunks
    return [f"<results>/study_chunks/{wildcards.name}/{k + 1}-of-{count}.nc" for k in range(count)]


def figure_files(chapter):
    """Return the files of the figures of a chapter, with their captions."""
    names = selection.figures_of(settings, chapter)
    return expand("<results>/figures/{name}.{kind}", name=names, kind=["pdf", "png", "rst"])


def table_files(chapter):
    """Return the files of the tables of a chapter, with their captions."""
    names = selection.tables_of(chapter)
    return expand("<results>/tables/{name}.{kind}", name=names, kind=["csv", "md", "rst"])


def target_files(stage):
    """Return the files that the target of a stage makes.

    For a stage of the paper these are the datasets. For another stage, pages are added, and the
    figures and tables of the chapters that show the stage and are not part of the paper.
    """
    if STAGES[stage].paper:
        return data(stage)
    beside = {table.chapter for table in TABLES.values() if stage in table.stages} - set(PAPER)
    shown = [[*figure_files(chapter), *table_files(chapter)] for chapter in sorted(beside)]
    return [*data(stage), *shown, *page_files(stage)]


def page_files(stage):
    """Return the files of the pages of a stage's entries; none for a stage without pages."""
    names = data_names(stage) if STAGES[stage].page else []
    return expand(f"<results>/{stage}/{{name}}/index.html", name=names)


def in_report(chapter, folder, name, kind):
    """Return a file for Snakemake's report, with the caption that the chapter's job writes."""
    return report(
        f"<results>/{folder}/{name}.{kind}",
        caption=os.path.abspath(f"{settings.results}/{folder}/{name}.rst"),
        category=CHAPTERS[chapter],
        labels={"kind": folder.removesuffix("s"), "name": name},
    )


def chapter_files(chapter):
    """Return the outputs of the job of a chapter: figures, tables and captions."""
    figures, tables = selection.figures_of(settings, chapter), selection.tables_of(chapter)
    return [
        *expand("<results>/figures/{name}.{kind}", name=figures, kind=["pdf", "rst"]),
        *expand("<results>/tables/{name}.{kind}", name=tables, kind=["md", "rst"]),
        *[in_report(chapter, "figures", name, "png") for name in figures],
        *[in_report(chapter, "tables", name, "csv") for name in tables],
    ]


def write_provenance():
    """Write versions, commit and computer into `provenance.json`."""
    from chatterjee1995.workflow.provenance import provenance

    path = Path(settings.results) / "provenance.json"
    part = path.with_name(f"{path.name}.part-{os.getpid()}")
    found = provenance(config, ROOT) | {"checked": digest(config)}
    part.write_text(json.dumps(found, indent=2) + "\n")
    os.replace(part, path)


def compile_again():
    """Compile the kernels again if the marker file exists and has another digest of the sources."""
    orders = settings.comparison.orders
    marker, now = Path(settings.results) / "kernels.compiled", compiled_kernels(orders)
    if not marker.exists() or marker.read_bytes() == now.encode():
        return
    logger.info("Compiling the kernels again: they were edited")
    program = [sys.executable, "-m", "chatterjee1995.workflow.kernels"]
    arguments = json.dumps([workflow.cores or 1, orders])
    if subprocess.run([*program, arguments]).returncode:
        raise WorkflowError("The kernels cannot be compiled: see the error above.")
    marker.write_text(now)
