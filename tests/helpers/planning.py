"""Jobs of a configuration as the registry of stages plans them, without starting Snakemake."""

from pathlib import Path
from typing import NamedTuple

from chatterjee1995.sections import selection
from chatterjee1995.sections.configuration import configuration
from chatterjee1995.sections.registry import CHAPTERS, STAGES


class Job(NamedTuple):
    """A job as Snakemake compares it: its parameters as texts, and the jobs that it needs."""

    parameters: frozenset
    needs: frozenset


def job_of(stage, name):
    """Return the name of the job that computes an entry."""
    return stage if STAGES[stage].together else f"{stage}/{name}"


def jobs(given) -> dict:
    """Return the jobs of a configuration with `chunks: 1`, by names like "response/figure_08"."""
    config, found = configuration(given, trusted=True), {}
    for name, stage in STAGES.items():
        entries = selection.entries(config, name)
        if name == "studies":
            found |= _studies(config, entries)
            continue
        function = {"function": stage.function}
        given = {entry: selection.job(config, name, entry) for entry in entries}
        if stage.together:
            given = {f"entry_{entry}": values for entry, values in given.items()}
            found[name] = Job(_texts(function | given), frozenset())
            continue
        for entry in entries:
            read = selection.read_by(config, name, entry).values()
            needs = _needed({each: [entry] for stages in read for each in stages})
            parameters = _texts({"name": entry} | function | given[entry])
            found[f"{name}/{entry}"] = Job(parameters, needs)
        if stage.page:
            found[f"pages/{name}"] = Job(_texts({"names": entries}), _needed({name: entries}))
    for chapter in CHAPTERS:
        given = selection.chapter_values(config, chapter)
        needs = _needed(selection.chapter_data(config, chapter))
        found[f"chapter/{chapter}"] = Job(_texts(given), needs)
    return found


def _studies(config, entries):
    """Return the jobs of studies, each of one chunk."""
    found = {}
    for entry in entries:
        chunk = {"name": f"{entry}/1-of-1", "function": STAGES["studies"].function}
        chunk |= config.studies[entry].chunk(config, "1-of-1")
        found[f"study_chunks/{entry}"] = Job(_texts(chunk), frozenset())
        needs = frozenset([f"study_chunks/{entry}"])
        found[f"studies/{entry}"] = Job(_texts({"name": entry}), needs)
    return found


def _texts(given):
    return frozenset(repr({key: value}) for key, value in given.items())


def _needed(names):
    return frozenset(job_of(stage, name) for stage, chosen in names.items() for name in chosen)


def job_of_file(config, path):
    """Return the name of the job that makes a file of the results."""
    path = Path(path)
    folder, name = path.parent.name, path.stem
    if folder == "figures":
        chapters = (c for c in CHAPTERS if name in selection.figures_of(config, c))
        return f"chapter/{next(chapters)}"
    if folder == "tables":
        return f"chapter/{next(c for c in CHAPTERS if name in selection.tables_of(c))}"
    if path.parent.parent.name in STAGES:
        return f"pages/{path.parent.parent.name}"
    if path.parent.parent.name == "study_chunks":
        return f"study_chunks/{folder}"
    return job_of(folder, name) if folder in STAGES else name


def reruns(before, after, edited=()) -> set:
    """Return the names of the jobs that run again after an edit.

    These are the jobs in `edited`, jobs whose parameters or needs differ between the two plans
    `before` and `after`, and all jobs that depend on them.
    """
    found = {name for name, job in after.items() if job != before.get(name)} | set(edited)
    new = found
    while new:
        new = {name for name, job in after.items() if job.needs & new} - found
        found = found | new
    return found
