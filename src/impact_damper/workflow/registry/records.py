"""Records of the registry: a stage, a table and a kind of figure."""

from collections.abc import Callable
from typing import NamedTuple


class Stage(NamedTuple):
    """A stage; its rule, script, folder of results and key of datasets all have the name `name`.

    Attributes
    ----------
    name : str
    section : str
        Section of the configuration. The stage makes a dataset of each entry; an entry of `curves`
        lists the stages that it goes through.
    parameters : callable
        Maps the configuration and the name of an entry to the parameters of the entry's job: the
        values that the job reads and no others, since a change of any of them reruns the job.
    reads : tuple of str
        Stages whose datasets of the same entry the job reads.
    paper : bool
        Whether the command `snakemake` without a target makes its data. Otherwise only the target
        `all_<name>` makes them, together with the figures and tables of its chapter. The stages of
        one chapter must agree in this.
    page : tuple of str
        Figures of the page of each entry, stored in a folder with the name of the entry; empty if
        the stage makes no pages.
    """

    name: str
    section: str
    parameters: Callable
    reads: tuple[str, ...] = ()
    paper: bool = True
    page: tuple[str, ...] = ()


class Table(NamedTuple):
    """A table, made by the function with the same name as the table.

    Its CSV has all columns. `SHOWN` of its module, keyed by name of table, has the heads of the
    columns of its Markdown, at most nine.

    Attributes
    ----------
    name : str
    module : str
        Its module in the package, as "tables.design".
    stages : tuple of str
        Stages whose datasets it condenses.
    caption : str
        Its caption in the report.
    pictures : bool
        Whether its Markdown shows figures: its `document` gets the names of those that the run
        draws.
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
        Stages whose datasets it draws. An entry of `curves` must go through the first one.
    module : str
        Its module in the package, if that is not "figures.<name>".
    most : int
        Most entries that a figure draws.
    damper : bool
        Whether the curves it draws have a damper. Their free oscillators are drawn with them.
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
        return self.module or f"figures.{self.name}"
