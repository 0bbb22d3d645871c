"""Harmonic balance: its convergence, rules for the clearance, and maps of its errors."""

from typing import ClassVar

from chatterjee1995.variables.balance_map import MAPPED
from chatterjee1995.workflow.models.system import (
    BOUNDS,
    CLEARANCE_OR_RULE,
    COMMON,
    CONTACT_STIFFNESS,
    DAMPER,
    FREQUENCY,
    MASS_RATIO,
    NEEDED,
    OSCILLATOR,
    RESTITUTION,
    MaybeWithDamper,
    WithOscillator,
    given,
    keys_of,
    range_of,
)
from impact_damper.command.messages import missing, problem
from impact_damper.command.section import increasing
from impact_damper.command.values import choice, count, number, several
from impact_damper.model.bounds import FREQUENCY_RANGE, HARMONIC_RANGE, plain


class HarmonicConvergence(MaybeWithDamper):
    """Motions by harmonic balance with a rising number of harmonics, and their errors."""

    whole: ClassVar = (*NEEDED, "contact_stiffness")

    contact_stiffness: CONTACT_STIFFNESS = None
    frequency: FREQUENCY
    highest: count("highest harmonic; the work grows with its cube", **HARMONIC_RANGE)
    highest_cold: count(
        "highest harmonic of a cold start (Newton's method begun from the solution with one "
        "harmonic)",
        **HARMONIC_RANGE | {"least": 0},
    )


class DesignRules(WithOscillator):
    """Grids of dampers and frequencies on which rules for the clearance are compared."""

    mass_ratios: several(
        MASS_RATIO,
        "rm, increasing, at most one for each distinct line style",
        least=1,
        most=5,
    )
    restitutions: several(RESTITUTION, "e, increasing", least=1)
    contact_stiffnesses: several(CONTACT_STIFFNESS, "r1, increasing", least=1)
    frequencies: several(FREQUENCY, "W, increasing, above the linear frequency", least=1)

    counts: ClassVar = ("mass_ratios", "restitutions", "contact_stiffnesses", "frequencies")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        for key in self.counts:
            yield from increasing((*path, key), getattr(self, key), "a grid ascends")
        known = config.oscillators.get(self.oscillator)
        if known and self.frequencies[0] <= known.linear_frequency:
            linear = known.linear_frequency
            reason = f"must lie above the linear frequency {linear!r} (the rules hold above it)"
            yield problem((*path, "frequencies"), self.frequencies, reason)


class BalanceMap(
    keys_of(OSCILLATOR, needed=["linear_frequency"]), keys_of(DAMPER, without=[COMMON])
):
    """Maps of the errors of harmonic balance, over frequency and another parameter."""

    parameter: choice("parameter that changes from row to row", *MAPPED)
    values: range_of(
        number("value of the parameter that changes, within its bounds", above=0, most=1000)
    )
    frequency_ratios: range_of(number("forcing over peak frequency", **FREQUENCY_RANGE))
    clearance: CLEARANCE_OR_RULE = None

    def contradictions(self, path, config):
        least, most = BOUNDS[self.parameter]["least"], BOUNDS[self.parameter]["most"]
        for end in ("first", "last"):
            value = getattr(self.values, end)
            if not least <= value <= most:
                bounds = f"from {plain(least)} to {plain(most)}"
                reason = f"must be {bounds} (bounds of {self.parameter})"
                yield problem((*path, "values", end), value, reason)
        for key in MAPPED:
            value = getattr(self, key)
            if key == self.parameter and value is not None:
                reason = "must be left out (it changes from row to row)"
                yield problem((*path, key), value, reason)
            elif key != self.parameter and value is None:
                yield missing((*path, key), f"needed where {self.parameter} changes")

    def ends(self):
        """Return the parameters of the first and of the last row."""
        fixed = given(self, [*OSCILLATOR, *DAMPER])
        return [fixed | {self.parameter: x} for x in (self.values.first, self.values.last)]


SECTIONS = {
    "harmonic_convergence": HarmonicConvergence,
    "design_rules": DesignRules,
    "balance_map": BalanceMap,
}
