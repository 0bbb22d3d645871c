"""Records that describe stages, kinds of figures and tables, for the workflow and the tests."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple


class Stage(NamedTuple):
    """A step of the workflow that computes a dataset for each entry of a section."""

    name: str
    section: str
    # Method of an entry. It takes the whole configuration and returns the arguments of `function`.
    # Some arguments describe objects that `workflow.job.made` makes.
    job: Callable
    function: str  # "module:name" of the function that computes the dataset
    message: str  # printed for each job
    reads: dict = {}  # argument of `function` -> stages whose datasets of the entry it gets
    files: dict = {}  # argument of `function` -> JSON file whose content it gets
    together: bool = False  # whether one job computes all entries (jobs start slowly)
    # 2: other jobs wait for these jobs. 1: the longest jobs, which should not start last.
    priority: int = 0
    paper: bool = True  # whether `snakemake` without a target computes the stage
    page: bool = False  # whether each entry has its own page


def stage(function, message, **options):
    """Mark a method of a section as a stage's job. The stage's name is by default the method's."""

    def mark(job):
        job.stage = {"name": job.__name__, "function": function, "message": message} | options
        return job

    return mark


@dataclass(frozen=True)
class Shown:
    """A table, or a kind of figure, of a chapter. A function of `module` makes it from datasets."""

    name: str
    chapter: str
    module: str  # name in the package `tables` or `figures`, or full name
    stages: tuple[str, ...]  # stages read; a drawn entry of `curves` must list the first of them

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
    """A kind of figure, drawn by `draw_<name>`. For a schematic, `data` names the function."""

    room = "figures"
    most: int = 6  # largest number of entries in a figure
    # If True, entries of `curves` must have a damper; if False, they must have none. If True, a
    # figure that reads `branches` also draws the branches of its oscillators without a damper.
    damper: bool = True
