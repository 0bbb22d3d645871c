"""The whole configuration. It is checked before any job starts. An error lists all problems."""

from contextlib import suppress

from pydantic import ValidationError, create_model

from chatterjee1995.sections.methods import Comparison
from chatterjee1995.sections.registry import KINDS, SECTIONS, TABLES, section_of
from chatterjee1995.sections.system import CONTACT_STIFFNESS, RADIUS, Oscillators, too_many
from impact_damper.command.section import (
    ConfigurationError,
    Section,
    choice,
    count,
    dotted,
    entries,
    missing,
    number,
    one_of,
    parts,
    points_of,
    problem,
    problems_of,
    several,
    starts_of,
    text,
)
from impact_damper.model import bounds

# Pairs of keys. A job has (first value) x (second value) runs, and this number is bounded.
COUNTS = (
    ("points.free", "search.starts"),
    ("points.simulated", "search.starts"),
    ("points.clearances", "search.sweep_starts"),
    ("points.scanned", "search.scan_starts"),
    ("points.scanned", "controller.releases"),
    ("points.map_frequencies", "points.map_values"),
)
# Names of drawings. A figure of the kind `schematic` names its drawing in the key `data`.
SCHEMATICS = ("elastic_model", "inelastic_model", "migration_scheme", "algorithm", "impact_pair")

TEXT = text("in Markdown or reStructuredText without links")


class Points(Section):
    """How many points the grids have."""

    harmonic_balance: points_of("frequencies at which equations of harmonic balance are solved")
    free: points_of("frequencies of simulated motions without a damper")
    simulated: points_of("frequencies of simulated motions with a damper")
    clearances: points_of("clearances of the sweep for an optimum")
    scanned: points_of("frequencies of a release scan")
    map_frequencies: points_of("frequencies of a map of harmonic balance")
    map_values: points_of("values of the other parameter of a map of harmonic balance")


class Search(Section):
    """Random starts (initial states) from which motions are searched for."""

    starts: starts_of("at each frequency of a response")
    sweep_starts: starts_of("at each clearance of the sweep for an optimum")
    scan_starts: starts_of("at each frequency of a release scan")
    study_starts: starts_of("in each cell of a study")
    radius: RADIUS
    life_runs: count("runs that measure how long a chaotic motion lasts", least=0, most=1000)
    life_periods: count("forcing cycles of the runs `life_runs`", **bounds.LIFETIME_RANGE)

    def job(self, config, starts) -> dict:
        return {"starts": starts, "radius": self.radius, "seed": config.seed}


class Settling(Section):
    """Length of runs, and tolerance of the integrator."""

    tolerance: number("local error allowed in a step of the integrator", **bounds.TOLERANCE_RANGE)
    patience: count(
        "forcing cycles after which a motion that is certainly chaotic is stopped",
        **bounds.PATIENCE_RANGE,
    )
    limit: count("forcing cycles after which every other motion is stopped", **bounds.LIMIT_RANGE)
    further: count(
        "largest number of forcing cycles for which an undecided motion is continued",
        **bounds.FURTHER_RANGE,
    )
    watched: count(
        "forcing cycles over which a motion that has not settled is measured",
        **bounds.WATCHED_RANGE,
    )

    def job(self) -> dict:
        return {"settling": {"Settling": dict(self)}}

    def contradictions(self, path, config):
        if self.limit < self.patience:
            reason = f"must be at least settling.patience = {self.patience} (it comes later)"
            yield problem((*path, "limit"), self.limit, reason)


class Controller(Section):
    """The controller that switches the damper (the paper's figure 17), and the runs with it."""

    trials: count("runs of each case", **bounds.RUNS_RANGE)
    periods: count(
        "forcing cycles of a run after which no switching begins", **bounds.PERIODS_RANGE
    )
    releases: count(
        "releases of each motion with damper, and number of long runs that measure lifetimes",
        **bounds.RUNS_RANGE,
    )
    lifetime: count("forcing cycles of the long runs", **bounds.LIFETIME_RANGE)


class Captions(Section):
    """Captions of tables, and texts that the captions of all figures of one kind share."""

    figures: entries(TEXT)
    tables: entries(TEXT)

    def contradictions(self, path, config):
        for key, known in (("figures", KINDS), ("tables", TABLES)):
            texts = getattr(self, key)
            for name in sorted(known.keys() - texts.keys()):
                yield missing((*path, key, name), "each kind of figure and each table has one")
            for name in sorted(texts.keys() - known.keys()):
                yield problem((*path, key, name), texts[name], one_of(name, known))


class Figure(Section):
    """Figures: the kind of drawing, the entries drawn, and the caption."""

    kind: choice("kind of drawing", *KINDS)
    data: several(
        text("name of an entry"),
        "entries to draw, at most one for each distinct line style",
        least=1,
        most=max(kind.most for kind in KINDS.values()),
        distinct=True,
    )
    title: text("first sentence of the caption, without the full stop", least=1)
    remark: text("rest of the caption, which may be empty")

    def contradictions(self, path, config):
        kind, section, data = KINDS[self.kind], section_of(self.kind), (*path, "data")
        known = getattr(config, section) if section else SCHEMATICS
        if len(self.data) > kind.most:
            reason = f"must be {kind.most} at most (what a figure of the kind {kind.name} draws)"
            yield problem(data, self.data, reason)
        for place, name in enumerate(self.data):
            if name not in known:
                yield problem((*data, place), name, one_of(name, known))
            elif section == "curves":
                yield from _curve_not_drawable((*data, place), name, kind, config)


def _curve_not_drawable(path, name, kind, config):
    curve, stage = config.curves[name], kind.stages[0]
    if stage not in curve.stages:
        reason = f"must hold {stage} (what {dotted(path[:2])} draws)"
        yield problem(("curves", name, "stages"), curve.stages, reason)
    if kind.damper != curve.has_damper():
        word = "with" if kind.damper else "without"
        yield problem(path, name, f"must be a curve {word} a damper (the kind {kind.name})")


class Settings(Section):
    """Settings that hold for all stages."""

    results: text(
        "folder below the working directory, without spaces or leading dots",
        pattern="[A-Za-z0-9_][A-Za-z0-9_.-]*(/[A-Za-z0-9_][A-Za-z0-9_.-]*)*",
    )
    seed: count("seed of all random draws", **bounds.SEED_RANGE)
    contact_stiffness: CONTACT_STIFFNESS
    chunks: count("number of jobs into which a study is divided", least=1, most=100000)
    points: Points
    search: Search
    settling: Settling
    controller: Controller
    comparison: Comparison
    captions: Captions

    def contradictions(self, path, config):
        for keys in COUNTS:
            yield from too_many(path, self, keys)


ENTRIES = {"oscillators": Oscillators} | SECTIONS | {"figures": Figure}
Configuration = create_model(
    "Configuration", __base__=Settings, **{name: entries(model) for name, model in ENTRIES.items()}
)


def configuration(given, trusted=False):
    """Check the configuration `given` and return it. If `trusted`, skip the slow checks."""
    try:
        found = Configuration.model_validate(without_left_out(given), context=trusted)
    except ValidationError as error:
        raise ConfigurationError("\n".join(problems_of(error))) from None
    lines = [
        line
        for path, part in (() if trusted else parts(found))
        for line in part.contradictions(path, found)
    ]
    if lines:
        raise ConfigurationError("\n".join(dict.fromkeys(lines)))
    return found


def without_left_out(given):
    """Return the configuration without null entries, and without their names in figures."""
    if not isinstance(given, dict):
        return given
    sections = {key: value for key, value in given.items() if isinstance(value, dict)}
    kept = given | {
        key: {name: entry for name, entry in section.items() if entry is not None}
        for key, section in sections.items()
    }
    for name, figure in list(sections.get("figures", {}).items()):
        with suppress(AttributeError, KeyError, TypeError):  # a later check reports wrong types
            known = sections[section_of(figure["kind"])]
            data = [each for each in figure["data"] if known.get(each, "") is not None]
            if len(data) < len(figure["data"]):
                kept["figures"][name] = figure | {"data": data}
                if not data:
                    del kept["figures"][name]
    return kept
