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
    function: str  # computes the dataset, as "module:function"
    message: str  # printed for a job
    reads: dict = {}  # keyword of the function -> stages whose datasets of the same entry it gets
    files: dict = {}  # keyword of the function -> JSON file of the project that it gets
    together: bool = False  # one job computes all entries: its start takes longer than its work
    # 2 for jobs for which other jobs wait, 1 for the longest jobs, which should not start last.
    priority: int = 0
    paper: bool = True  # computed by `snakemake` without a target
    page: bool = False  # each entry has a page


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
    module: str  # name in the room `tables` or `figures`, or full name
    stages: tuple[str, ...]  # those it reads; a drawn entry of `curves` must have the first

    room: ClassVar[str]

    @property
    def source(self) -> str:
        """Full name of the module."""
        return self.module if "." in self.module else f"chatterjee1995.{self.room}.{self.module}"


@dataclass(frozen=True)
class Table(Shown):
    """A table, made by the function with its name."""

    room = "tables"
    pictures: bool = False  # its Markdown shows figures and needs their names


@dataclass(frozen=True)
class Kind(Shown):
    """A kind of figure, drawn by the function `draw_<name>`."""

    room = "figures"
    most: int = 6  # largest number of entries in a figure
    # Whether entries of `curves` must have a damper, or must have none. If they have one, a figure
    # with `branches` also draws those of the same oscillators without a damper.
    damper: bool = True
