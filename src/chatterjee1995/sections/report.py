"""Figures and captions: what is drawn, and the texts of the report."""

from chatterjee1995.sections.clearance import points
from chatterjee1995.sections.registry import KINDS, TABLES, section_of
from chatterjee1995.sections.system import Range
from impact_damper.command.messages import dotted, missing, one_of, problem
from impact_damper.command.section import Section
from impact_damper.command.values import choice, entries, several, text

# Names of drawings, which a figure of the kind `schematic` has in place of entries.
SCHEMATICS = ("elastic_model", "inelastic_model", "migration_scheme", "algorithm", "impact_pair")

TEXT = text("in Markdown or reStructuredText without links")


class Captions(Section):
    """Captions of tables, and the texts that all figures of a kind share, by their names."""

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
            elif section == "studies":
                yield from _study_not_drawable(dotted(path), name, known[name])


def _curve_not_drawable(path, name, kind, config):
    """Yield a line for each reason why a kind of figure cannot draw a curve."""
    curve, stage = config.curves[name], kind.stages[0]
    if stage not in curve.stages:
        reason = f"must hold {stage} (what {dotted(path[:2])} draws)"
        yield problem(("curves", name, "stages"), curve.stages, reason)
    if kind.damper != curve.has_damper():
        word = "with" if kind.damper else "without"
        yield problem(path, name, f"must be a curve {word} a damper (the kind {kind.name})")
    elif kind.damper and "branches" in kind.stages:
        free = [
            each
            for each in config.curves.values()
            if each.oscillator == curve.oscillator
            and not each.has_damper()
            and "branches" in each.stages
        ]
        if not free:
            yield problem(
                path,
                name,
                "must have beside it an entry of curves with the oscillator "
                f"{dotted([curve.oscillator])}, no damper, and the stage branches (which the "
                "figure draws too)",
            )


def _study_not_drawable(figure, name, study):
    """Yield a line for each value of a study that a map cannot show."""
    for key in ("mass_ratio", "clearance"):
        if not isinstance(getattr(study, key), Range):
            reason = f"must be a range (an axis of the map of {figure})"
            yield problem(("studies", name, key), getattr(study, key), reason)
    for key in ("frequency", "restitution"):
        count = points(getattr(study, key))
        if count > 3:
            reason = f"must be at most 3 (panels of {figure} side by side)"
            yield problem(("studies", name, key, "points"), count, reason)
