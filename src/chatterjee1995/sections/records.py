"""Records that describe stages, kinds of figures and tables, for the workflow and the tests."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple


class Stage(NamedTuple):
    """A step of the workflow that computes a dataset for each entry of a section."""

    name: str
    section: str
    # A method of each entry: it takes the configuration and returns the arguments of `function`.
    # The module `workflow.job` makes objects from arguments such as {"Damper": {...}}.
    job: Callable
    function: str  # "module:name" of the function that computes the dataset
    message: str  # printed for each job
    reads: dict = {}  # argument of `function` -> stages that compute its value for the entry
    files: dict = {}  # argument of `function` -> JSON file; the content is the argument's value
    together: bool = False  # whether one job computes all entries (jobs start slowly)
    # 2 if other jobs wait for this job; 1 for long jobs, which should not start last; else 0.
    priority: int = 0
    paper: bool = True  # whether `snakemake` without a target computes the stage
    page: bool = False  # whether each entry has its own page


def stage(function, message, **options):
    """Return a decorator. The method that it decorates becomes the field `job` of a `Stage`.

    The arguments are other fields of the `Stage`. Its field `name` is by default the method's name.
    """

    def mark(job):
        job.stage = {"name": job.__name__, "function": function, "message": message} | options
        return job

    return mark


@dataclass(frozen=True)
class Shown:
    """A table or a kind of figure, made from datasets by a function in the module `module`."""

    name: str
    chapter: str
    module: str  # name in the package `tables` or `figures`, or full name
    stages: tuple[str, ...]  # stages read; a curve that is drawn must list the first stage

    room: ClassVar[str]

    @property
    def source(self) -> str:
        return self.module if "." in self.module else f"chatterjee1995.{self.room}.{self.module}"


@dataclass(frozen=True)
class Table(Shown):
    """A table. The function that makes the table has the table's name."""

    room = "tables"
    pictures: bool = False  # whether the Markdown page shows figures


@dataclass(frozen=True)
class Kind(Shown):
    """A kind of figure, drawn by `draw_<name>`. A schematic names its drawing in the key `data`."""

    room = "figures"
    most: int = 6  # largest number of entries in a figure
    # Whether all curves in a figure must have a damper (True) or must have none (False). If True,
    # a figure that reads the stage `branches` also shows orbits of the free oscillators.
    damper: bool = True
