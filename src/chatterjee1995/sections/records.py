"""Records that describe stages, kinds of figures and tables, for the workflow and the tests."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple


class Stage(NamedTuple):
    """A step of the workflow that computes a dataset for each entry of a section."""

    name: str
    section: str
    # Method of an entry. It takes the whole configuration and returns the keywords of `function`,
    # in forms that `workflow.job.made` reads.
    job: Callable
    function: str  # computes the dataset, as "module:function"
    message: str  # printed for a job
    reads: dict = {}  # keyword of `function` -> stages; their datasets of the same entry are passed
    files: dict = {}  # keyword of `function` -> JSON file of the project; its content is passed
    together: bool = False  # whether one job computes all entries, to save starts of jobs
    # 2 for jobs for which other jobs wait, 1 for the longest jobs, which should not start last.
    priority: int = 0
    paper: bool = True  # whether `snakemake` without a target computes the stage
    page: bool = False  # whether each entry has its own page


def stage(function, message, **options):
    """Mark a method of a section as the job of a stage, which gets the method's name by default."""

    def mark(job):
        job.stage = {"name": job.__name__, "function": function, "message": message} | options
        return job

    return mark


@dataclass(frozen=True)
class Shown:
    """A table or kind of figure of a chapter, made from datasets by a function of a module."""

    name: str
    chapter: str
    module: str  # name in the package `tables` or `figures`, or full name
    stages: tuple[str, ...]  # stages read; drawn entries of `curves` must list the first stage

    room: ClassVar[str]

    @property
    def source(self) -> str:
        """Full name of the module."""
        return self.module if "." in self.module else f"chatterjee1995.{self.room}.{self.module}"


@dataclass(frozen=True)
class Table(Shown):
    """A table, made by the function with its name."""

    room = "tables"
    pictures: bool = False  # whether its Markdown shows figures


@dataclass(frozen=True)
class Kind(Shown):
    """A kind of figure, drawn by the function `draw_<name>`; a schematic by one named in `data`."""

    room = "figures"
    most: int = 6  # largest number of entries in a figure
    # Entries of `curves` must have a damper (True) or must have none (False). If True, a figure
    # that reads `branches` also draws the branches of the same oscillators without a damper.
    damper: bool = True
