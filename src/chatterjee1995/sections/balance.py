"""Sections on harmonic balance: errors by number of harmonics, and maps of errors."""

from typing import ClassVar

from chatterjee1995.sections import system
from chatterjee1995.sections.records import Kind, Table, stage
from impact_damper.command.section import choice, count, missing, number, problem
from impact_damper.model.bounds import FREQUENCY_RANGE, HARMONIC_RANGE
from impact_damper.model.text import plain

MAPPED = ("damping", "mass_ratio", "clearance", "restitution")  # a map varies one of these


class HarmonicConvergence(system.MaybeWithDamper):
    """Errors of harmonic balance with a rising number of harmonics, for a motion."""

    whole: ClassVar = (*system.NEEDED, "contact_stiffness")

    contact_stiffness: system.CONTACT_STIFFNESS = None
    frequency: system.FREQUENCY
    highest: count("highest harmonic; the work grows with its cube", **HARMONIC_RANGE)
    highest_cold: count(
        "highest harmonic of a cold start (Newton's method begun from the solution with one "
        "harmonic)",
        **HARMONIC_RANGE | {"least": 0},
    )

    @stage(
        "chatterjee1995.stages.harmonic_convergence:harmonic_convergence",
        "Harmonic balance with many harmonics against the exact orbit, for {name}",
    )
    def harmonic_convergence(self, config) -> dict:
        cold = min(self.highest, self.highest_cold)
        balances = {
            "frequency": self.frequency,
            "harmonics": {"ladder": [self.highest]},
            "cold": {"ladder": [cold]} if cold else [],
        }
        return self.system(config) | balances


class BalanceMap(
    system.keys_of(system.OSCILLATOR, needed=["linear_frequency"]),
    system.keys_of(system.DAMPER, without=[system.COMMON]),
):
    """Maps of the errors of harmonic balance, over frequency and another parameter."""

    parameter: choice("parameter that changes from row to row", *MAPPED)
    values: system.range_of(
        number("value of the parameter that changes, within its bounds", above=0, most=1000)
    )
    frequency_ratios: system.range_of(number("forcing over peak frequency", **FREQUENCY_RANGE))
    clearance: system.CLEARANCE_OR_RULE = None

    def contradictions(self, path, config):
        least, most = system.BOUNDS[self.parameter]["least"], system.BOUNDS[self.parameter]["most"]
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

    @stage(
        "chatterjee1995.stages.balance_map:balance_map",
        "Harmonic balance against exact motions, the map {name}",
        priority=1,
    )
    def balance_map(self, config) -> dict:
        # The clearance "rule" is left out: without a clearance, the stage uses rule (19).
        values = system.given(self, [*system.OSCILLATOR, *system.DAMPER]).items()
        fixed = {key: value for key, value in values if value != "rule"}
        points = config.points
        return {
            "parameter": self.parameter,
            "values": self.values.even(points.map_values),
            "frequency_ratios": self.frequency_ratios.even(points.map_frequencies),
            "fixed": {system.COMMON: config.contact_stiffness} | fixed,
        } | config.settling.job()


SECTIONS = {"harmonic_convergence": HarmonicConvergence, "balance_map": BalanceMap}
KINDS = (
    Kind("harmonic_convergence", "design", "balance", ("harmonic_convergence",), most=5),
    Kind("balance_map", "methods", "balance", ("balance_map",), most=1),
)
TABLES = (
    Table("harmonic_convergence", "design", "balance", ("harmonic_convergence",)),
    Table("balance_map", "methods", "balance", ("balance_map",)),
)
