"""Records of a stage, a kind of figure and a table, which the workflow and the tests read."""

from collections.abc import Callable
from typing import NamedTuple


class Stage(NamedTuple):
    """A step of the workflow that computes a dataset for each entry of a section.

    Attributes
    ----------
    name, section : str
    job : callable
        Method of an entry: the parameters of its job, from the whole configuration. They are the
        keywords of `function`, in forms that `workflow.job.made` reads.
    function : str
        Function that computes the dataset, as "module:function".
    message : str
        What a run prints for a job.
    reads : dict
        Keyword of the function -> stages whose datasets of the same entry it gets.
    files : dict
        Keyword of the function -> JSON file of the project that it gets.
    together : bool
        Whether one job computes all entries, because starting a job takes longer than its work.
    priority : int
        2 for jobs for which other jobs wait, 1 for the longest jobs, which should not start last.
    paper : bool
        Whether `snakemake` without a target computes it.
    page : tuple of str
        Names of the figures on the page of an entry; empty without pages.
    """

    name: str
    section: str
    job: Callable
    function: str
    message: str
    reads: dict = {}
    files: dict = {}
    together: bool = False
    priority: int = 0
    paper: bool = True
    page: tuple[str, ...] = ()


def stage(function, message, **options):
    """Mark a method of a section's class as the job of the stage with the method's name."""

    def mark(job):
        job.stage = {"name": job.__name__, "function": function, "message": message} | options
        return job

    return mark


class Table(NamedTuple):
    """A table of a chapter, made by the function of the same name in a module.

    The CSV file has all columns, the Markdown file the first nine.

    Attributes
    ----------
    name, chapter : str
    module : str
        Full name of the module, or its name in `chatterjee1995.tables`.
    stages : tuple of str
        Stages whose datasets it summarises.
    pictures : bool
        Whether its Markdown shows figures, so that it needs their names.
    """

    name: str
    chapter: str
    module: str
    stages: tuple[str, ...]
    pictures: bool = False

    @property
    def source(self) -> str:
        """Full name of the module."""
        return self.module if "." in self.module else f"chatterjee1995.tables.{self.module}"


class Kind(NamedTuple):
    """A kind of figure, drawn by the function `draw_<name>` of a module.

    Attributes
    ----------
    name, chapter : str
    module : str
        Full name of the module, or its name in `chatterjee1995.figures`.
    stages : tuple of str
        Stages whose datasets it draws. An entry of `curves` must have the first of them.
    most : int
        Largest number of entries in a figure.
    damper : bool
        If it draws entries of `curves`: whether they must have a damper. If they must, and it draws
        `branches`, it also draws the branches of the same oscillators without a damper.
    named : bool
        Whether the caption names each entry.
    """

    name: str
    chapter: str
    module: str
    stages: tuple[str, ...]
    most: int = 6
    damper: bool = True
    named: bool = False

    @property
    def source(self) -> str:
        """Full name of the module."""
        return self.module if "." in self.module else f"chatterjee1995.figures.{self.module}"
