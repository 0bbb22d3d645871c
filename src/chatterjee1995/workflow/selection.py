"""Selection of the entries of a configuration for each stage, figure, table and chapter.

The sections of the configuration have named entries. A stage makes a dataset of each entry of its
section. A chapter is a part of the report with its own stages, figures and tables.
"""

from chatterjee1995.workflow.captions import cases_in_words, in_words, machine_in_words
from chatterjee1995.workflow.registry import CHAPTERS, KINDS, PAPER, STAGES, TABLES, section_of
from chatterjee1995.workflow.registry.values import oscillator

# Key of an entry that holds several values of a parameter -> name of the parameter.
SWEPT = {
    "mass_ratios": "mass_ratio",
    "clearances": "clearance",
    "restitutions": "restitution",
    "contact_stiffnesses": "contact_stiffness",
    "stiffnesses": "contact_stiffness",
    "frequencies": "frequency",
}


def entries(config, stage) -> list:
    """Return the names of the entries for which a stage is run."""
    section = config[STAGES[stage].section]
    return [name for name, entry in section.items() if stage in entry.get("stages", [stage])]


def read_by(config, stage, name) -> dict:
    """Return the entries whose datasets the job of an entry reads, keyed by stage."""
    return {earlier: [name] for earlier in STAGES[stage].reads if name in entries(config, earlier)}


def table_data(config, table) -> dict:
    """Return the entries whose datasets a table summarises, keyed by stage."""
    return {stage: entries(config, stage) for stage in TABLES[table].stages}


def figure_data(config, name) -> dict:
    """Return the entries that a figure draws, keyed by stage.

    A figure that draws branches of orbits with a damper also draws the branches of the same
    oscillators without a damper; these curves are added for the stage `branches`.
    """
    figure = config["figures"][name]
    kind, found = KINDS[figure["kind"]], {}
    for stage in kind.stages:
        drawn = list(figure["data"])
        if stage == "branches" and kind.damper:
            drawn += _free_curves(config, drawn)
        found[stage] = [each for each in drawn if each in entries(config, stage)]
    return found


def _free_curves(config, chosen):
    """Return the curves without a damper whose oscillator is also in one of the chosen curves."""
    curves = config["curves"]
    wanted = {curves[name]["oscillator"] for name in chosen}
    return [
        name
        for name, curve in curves.items()
        if curve["oscillator"] in wanted and "mass_ratio" not in curve
    ]


def figures_of(config, chapter) -> list:
    """Return the names of the figures of a chapter."""
    kinds = {kind.name for kind in CHAPTERS[chapter].KINDS}
    return [name for name, figure in config["figures"].items() if figure["kind"] in kinds]


def figure_values(config, name) -> dict:
    """Return the entry of a figure in the configuration, with two further keys.

    `cases` holds the parameters of the entries drawn, as text for the caption. `drawn` holds the
    result of `figure_data`.
    """
    figure = config["figures"][name]
    cases = {each: _case(config, figure["kind"], each) for each in figure["data"]}
    words = cases_in_words(cases, KINDS[figure["kind"]].named)
    return figure | {"cases": words, "drawn": figure_data(config, name)}


def chapter_values(config, chapter) -> dict:
    """Return the parameters of the job of a chapter: its figures, and the names of its tables.

    A chapter with a table that shows figures also gets the names of all figures of the paper's
    chapters.
    """
    tables = CHAPTERS[chapter].TABLES
    values = {f"figure_{name}": figure_values(config, name) for name in figures_of(config, chapter)}
    if any(table.pictures for table in tables):
        values["drawn"] = sorted(name for each in PAPER for name in figures_of(config, each))
    return values | {"tables": [table.name for table in tables]}


def _case(config, kind, name):
    """Return the parameters of an entry as text, keyed by symbol or name; {} for a schematic."""
    section = section_of(kind)
    if section is None:
        return {}
    entry = config[section][name]
    values = oscillator(config, entry["oscillator"]) if "oscillator" in entry else {}
    values |= entry | {swept: entry[key] for key, swept in SWEPT.items() if key in entry}
    return machine_in_words(entry["machine"]) if section == "machines" else in_words(values)


def chapter_data(config, chapter) -> dict:
    """Return the entries whose datasets a chapter reads, keyed by stage."""
    parts = [figure_data(config, name) for name in figures_of(config, chapter)]
    parts += [table_data(config, table.name) for table in CHAPTERS[chapter].TABLES]
    stages = dict.fromkeys(stage for part in parts for stage in part)
    return {
        stage: sorted({name for part in parts for name in part.get(stage, [])}) for stage in stages
    }


def chapter_modules(config, chapter) -> list:
    """Return the modules of the package that make the figures and tables of a chapter."""
    drawn = {config["figures"][name]["kind"] for name in figures_of(config, chapter)}
    sources = {KINDS[kind].source for kind in drawn}
    return sorted(sources | {table.module for table in CHAPTERS[chapter].TABLES})
