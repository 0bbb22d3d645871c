"""Jobs of a configuration as the registry of stages plans them, without starting Snakemake."""

import json
from pathlib import Path
from typing import NamedTuple

from chatterjee1995.workflow import selection
from chatterjee1995.workflow.registry import CHAPTERS, STAGES, TABLES

# Stages whose entries are all computed by one job.
TOGETHER = ("collisions", "design_orbit", "rigid_limit")


class Job(NamedTuple):
    """A job as Snakemake compares it: its parameters as texts, and the jobs that it needs."""

    parameters: frozenset
    needs: frozenset


def job_of(stage, name):
    """Return the name of the job that computes an entry."""
    return stage if stage in TOGETHER else f"{stage}/{name}"


def jobs(config) -> dict:
    """Return the jobs of a configuration with `chunks: 1`, by names like "response/figure_08"."""
    config = json.loads(json.dumps(config, sort_keys=True))
    found = {}
    for stage, record in STAGES.items():
        names = selection.entries(config, stage)
        given = {name: record.parameters(config, name) for name in names}
        if stage in TOGETHER:
            found[stage] = Job(_texts(given), frozenset())
            continue
        for name in names:
            needs = _needed(selection.read_by(config, stage, name))
            found[f"{stage}/{name}"] = Job(_texts({"name": name} | given[name]), needs)
        if record.page:
            found[f"pages/{stage}"] = Job(_texts({"names": names}), _needed({stage: names}))
    for chapter in CHAPTERS:
        given = selection.chapter_values(config, chapter)
        needs = _needed(selection.chapter_data(config, chapter))
        found[f"chapter/{chapter}"] = Job(_texts(given), needs)
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
        return f"chapter/{next(c for c in CHAPTERS if TABLES[name] in CHAPTERS[c].TABLES)}"
    if path.parent.parent.name in STAGES:
        return f"pages/{path.parent.parent.name}"
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
