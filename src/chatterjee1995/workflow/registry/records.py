"""Records of the registry: a stage, a table and a kind of figure."""

from collections.abc import Callable
from typing import NamedTuple

# Modules of the library that draw kinds of figures.
PANELS = "impact_damper.plot.panels.{}"


class Stage(NamedTuple):
    """A stage. Its rule, script, folder of results and key of datasets all have its name.

    Attributes
    ----------
    name : str
    section : str
        Section of the configuration. The stage makes a dataset for each entry. An entry of `curves`
        lists its stages.
    parameters : callable
        Function of the configuration and the name of an entry that returns the parameters of the
        entry's job. These are only the values that the job uses, since a change of any parameter
        reruns the job.
    reads : tuple of str
        Stages whose datasets of the same entry the job reads.
    paper : bool
        Whether the command `snakemake` without a target makes the data of the stage. Otherwise only
        the targets `all_<name>` and `everything` do, together with the figures and tables of its
        chapter. All stages of a chapter must have the same value.
    page : tuple of str
        If the stage makes a page for each entry: names of the figures on this page. Otherwise
        empty.
    """

    name: str
    section: str
    parameters: Callable
    reads: tuple[str, ...] = ()
    paper: bool = True
    page: tuple[str, ...] = ()


class Table(NamedTuple):
    """A table, made by the function with the same name as the table.

    The CSV file has all columns. The Markdown file has at most nine, whose heads are in `SHOWN` of
    the module, keyed by the name of the table.

    Attributes
    ----------
    name : str
    module : str
        Its module in the package, such as "chatterjee1995.tables.design".
    stages : tuple of str
        Stages whose datasets it summarises.
    caption : str
        Its caption in the report.
    pictures : bool
        Whether its Markdown shows figures. The function `document` of its module then gets the
        names of the figures that the run draws.
    """

    name: str
    module: str
    stages: tuple[str, ...]
    caption: str
    pictures: bool = False


class Kind(NamedTuple):
    """A kind of figure, drawn by `draw_<name>`.

    Attributes
    ----------
    name : str
    stages : tuple of str
        Stages whose datasets it draws. An entry of `curves` must have the first of these stages.
    module : str
        Its module in the package, if that is not "chatterjee1995.figures.<name>".
    most : int
        Largest number of entries in a figure.
    damper : bool
        If it draws entries of `curves`: whether they must have a damper. If so, and if it draws the
        stage `branches`, it also draws the curves of the same oscillators without damper.
    named : bool
        Whether the caption names each entry.
    """

    name: str
    stages: tuple[str, ...]
    module: str | None = None
    most: int = 6
    damper: bool = True
    named: bool = False

    @property
    def source(self) -> str:
        """Module in the package."""
        return self.module or f"chatterjee1995.figures.{self.name}"
