"""Records of a stage, a kind of figure and a table, which the workflow and the tests read."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple


class Stage(NamedTuple):
    """A step of the workflow that computes a dataset for each entry of a section."""

    name: str
    section: str
    # Method of an entry: from the whole configuration the keywords of `function`, in forms that
    # `workflow.job.made` reads.
    job: Callable
    # Function that computes the dataset, as "module:function".
    function: str
    # What a run prints for a job.
    message: str
    # Keyword of the function -> stages whose datasets of the same entry it gets.
    reads: dict = {}
    # Keyword of the function -> JSON file of the project that it gets.
    files: dict = {}
    # Whether one job computes all entries, because its start takes longer than its work.
    together: bool = False
    # 2 for jobs for which other jobs wait, 1 for the longest jobs, which should not start last.
    priority: int = 0
    # Whether `snakemake` without a target computes it.
    paper: bool = True
    # Whether each entry has a page.
    page: bool = False


def stage(function, message, **options):
    """Mark a method of a section's class as the job of the stage with the method's name."""

    def mark(job):
        job.stage = {"name": job.__name__, "function": function, "message": message} | options
        return job

    return mark


@dataclass(frozen=True)
class Shown:
    """What a chapter shows, made from the datasets of stages by a function of a module."""

    name: str
    chapter: str
    # Name of the module in the room `tables` or `figures`, or its full name.
    module: str
    # For a figure of `curves`: an entry must have the first of these stages.
    stages: tuple[str, ...]

    room: ClassVar[str]

    @property
    def source(self) -> str:
        """Full name of the module."""
        return self.module if "." in self.module else f"chatterjee1995.{self.room}.{self.module}"


@dataclass(frozen=True)
class Table(Shown):
    """A table, made by the function with its name."""

    room = "tables"
    # Whether its Markdown shows figures, so that it needs their names.
    pictures: bool = False


@dataclass(frozen=True)
class Kind(Shown):
    """A kind of figure, drawn by the function `draw_<name>`."""

    room = "figures"
    # Largest number of entries in a figure.
    most: int = 6
    # Whether entries of `curves` must have a damper, or must have none. If they have one, a figure
    # with `branches` also draws those of the same oscillators without a damper.
    damper: bool = True
