"""Functions that read from the configuration what stages, figures, tables and chapters need."""

import re

from chatterjee1995.sections.registry import KINDS, PAPER, STAGES, TABLES, section_of
from impact_damper.model.parameters import SYMBOLS
from impact_damper.model.text import number

MANY = 3  # length above which a list is written as its smallest and largest value only
# Key under which an entry lists values of a parameter -> name of the parameter.
SWEPT = {
    "mass_ratios": "mass_ratio",
    "clearances": "clearance",
    "restitutions": "restitution",
    "contact_stiffnesses": "contact_stiffness",
    "stiffnesses": "contact_stiffness",
    "frequencies": "frequency",
}


def entries(config, stage) -> list:
    """Return the names of the entries for which a stage is run, in alphabetic order."""
    section = getattr(config, STAGES[stage].section)
    return sorted(k for k, entry in section.items() if stage in getattr(entry, "stages", [stage]))


def job(config, stage, name) -> dict:
    """Return the parameters of the job that computes a stage for the entry `name`."""
    entry = getattr(config, STAGES[stage].section)[name]
    return STAGES[stage].job(entry, config)


def read_by(config, stage, name) -> dict:
    """Return a dict: argument of a stage's function -> stages whose datasets the argument holds."""
    return {
        key: [each for each in stages if name in entries(config, each)]
        for key, stages in STAGES[stage].reads.items()
    }


def figure_data(config, name) -> dict:
    """Return a dict: stage -> names of the entries whose datasets a figure draws."""
    figure = config.figures[name]
    kind, found = KINDS[figure.kind], {}
    for stage in kind.stages:
        drawn = list(figure.data)
        if stage == "branches" and kind.damper:
            oscillators = {config.curves[each].oscillator for each in drawn}
            drawn += [
                each
                for each, curve in sorted(config.curves.items())
                if curve.oscillator in oscillators and not curve.has_damper()
            ]
        found[stage] = [each for each in drawn if each in entries(config, stage)]
    return found


def figures_of(config, chapter) -> list:
    """Return the names of the figures of a chapter."""
    return sorted(k for k, each in config.figures.items() if KINDS[each.kind].chapter == chapter)


def tables_of(chapter) -> list:
    """Return the names of the tables of a chapter."""
    return [table.name for table in TABLES.values() if table.chapter == chapter]


def figure_values(config, name) -> dict:
    """Return what is needed to draw a figure: the function, its data and the caption."""
    figure = config.figures[name]
    kind = KINDS[figure.kind]
    cases = {each: _case(config, section_of(kind.name), each) for each in figure.data}
    words = cases_in_words(cases)
    text = config.captions.figures[kind.name]
    return {
        "function": f"{kind.source}:{f'draw_{kind.name}' if kind.stages else figure.data[0]}",
        "drawn": figure_data(config, name),
        "caption": caption(figure.title, words, text, figure.remark),
    }


def table_values(config, name) -> dict:
    """Return what is needed to make a table, such as its module and its caption."""
    table = TABLES[name]
    values = {
        "module": table.source,
        "stages": list(table.stages),
        "caption": config.captions.tables[name],
    }
    if table.pictures:
        values["drawn"] = sorted(each for chapter in PAPER for each in figures_of(config, chapter))
    return values


def chapter_values(config, chapter) -> dict:
    """Return the parameters of a chapter's job, one for each figure and table."""
    figures = {
        f"figure_{name}": figure_values(config, name) for name in figures_of(config, chapter)
    }
    return figures | {f"table_{name}": table_values(config, name) for name in tables_of(chapter)}


def chapter_data(config, chapter) -> dict:
    """Return a dict: stage -> names of the entries whose datasets a chapter reads."""
    read = [figure_data(config, name) for name in figures_of(config, chapter)]
    read += [
        {stage: entries(config, stage) for stage in TABLES[name].stages}
        for name in tables_of(chapter)
    ]
    stages = dict.fromkeys(stage for each in read for stage in each)
    return {
        stage: sorted({name for each in read for name in each.get(stage, [])}) for stage in stages
    }


def chapter_modules(config, chapter) -> list:
    """Return the modules that make the figures and tables of a chapter."""
    drawn = {KINDS[config.figures[name].kind].source for name in figures_of(config, chapter)}
    return sorted(drawn | {TABLES[name].source for name in tables_of(chapter)})


def _case(config, section, name):
    if section in (None, "machines"):
        return []
    entry = getattr(config, section)[name]
    values = {key: value for key, value in entry if value is not None}
    if "oscillator" in values:
        values = config.oscillators[values["oscillator"]].values() | values
    return in_words(values | {each: values[key] for key, each in SWEPT.items() if key in values})


def caption(title, cases, text, remark) -> str:
    """Return a caption: title, parameters (`cases`), text for this kind of figure, and remark."""
    head = f"{title}: {cases}." if cases else f"{title}."
    whole = "\n".join(part for part in (head, text.strip(), remark) if part)
    whole = re.sub(r"\bW(?=p?(²|\b))", "Ω", whole)
    # reStructuredText takes |Z1| for the name of a substitution.
    return whole.replace("omega_l", "ωl").replace("|", r"\|")


def cases_in_words(cases) -> str:
    """Return the parameters of a figure's entries as text; shared parameters come first."""
    shared = [each for each in next(iter(cases.values())) if all(each in x for x in cases.values())]
    parts = [", ".join(shared)]
    for name, case in cases.items():
        own = [each for each in case if each not in shared]
        parts += [f"{name.replace('_', ' ')} with {', '.join(own)}"] if own else []
    return "; ".join(filter(None, parts))


def in_words(values) -> list:
    """Return a text for each parameter, such as "h = 0.215", "W from 1 to 3" or "d0 by (19)"."""
    return [
        f"{symbol} {_value(values[name])}"
        for name, symbol in SYMBOLS.items()
        if name in values and (name, values[name]) != ("linear_frequency", 0)
    ]


def _value(value):
    if hasattr(value, "first"):
        return f"from {_number(value.first)} to {_number(value.last)}"
    if isinstance(value, list) and len(value) > MANY:
        return f"from {_number(min(value))} to {_number(max(value))}"
    if isinstance(value, list):
        return f"= {', '.join(map(_number, value))}"
    return "by (19)" if value == "rule" else f"= {_number(value)}"


def _number(value):
    return number(value, 6)
