"""Motions with and without a damper: curves over frequency, single motions, and migration."""

from chatterjee1995.workflow.models.system import (
    CLEARANCE,
    CLEARANCE_OR_RULE,
    COMMON,
    DAMPER,
    FREQUENCIES,
    FREQUENCY,
    NEEDED,
    MaybeWithDamper,
    WithDamper,
    WithOscillator,
    keys_of,
    range_of,
)
from chatterjee1995.workflow.registry import STAGES
from impact_damper.command.messages import dotted, problem
from impact_damper.command.section import increasing
from impact_damper.command.values import choice, count, entries, number, several, starts_of
from impact_damper.model.bounds import (
    FARTHEST,
    FASTEST,
    MOST_RUNS,
    PERIODS_RANGE,
    RUNS_RANGE,
    SCAN_LIFETIME_RANGE,
)

# Stages of an entry of `curves`, and which of them need a damper.
STAGES_OF_CURVES = [stage.name for stage in STAGES.values() if stage.section == "curves"]
NEED_DAMPER = ("design_orbit", "subharmonic")


class Curve(MaybeWithDamper):
    """Response curves over frequency, of an oscillator with or without a damper."""

    clearance: CLEARANCE_OR_RULE = None
    stages: several(
        choice("", *STAGES_OF_CURVES), "stages to compute for the curve", least=1, distinct=True
    )

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        starts, stages = config.search.starts, (*path, "stages")
        if "subharmonic" in self.stages and starts < 2:
            reason = f"must be at least 2 with {dotted(stages)} subharmonic (half are switched on)"
            yield problem(("search", "starts"), starts, reason)
        if "branches" in self.stages and "response" not in self.stages:
            reason = "must hold response with branches (orbits are followed from the motions found)"
            yield problem(stages, self.stages, reason)
        if not self.has_damper():
            for stage in sorted(set(NEED_DAMPER) & set(self.stages)):
                reason = f"must not hold {stage} without a damper (mass_ratio and so on)"
                yield problem(stages, self.stages, reason)
        if "harmonic_balance" in self.stages and self.restitution not in (None, 1):
            reason = "must be 1 with the stage harmonic_balance (it knows elastic contact only)"
            yield problem((*path, "restitution"), self.restitution, reason)
        if self.clearance == "rule" and set(self.stages) - {"harmonic_balance", "design_orbit"}:
            reason = "must be a number with stages other than harmonic_balance and design_orbit"
            reason = f"{reason} (see table harmonic_balance)"
            yield problem((*path, "clearance"), self.clearance, reason)


class Motion(WithDamper):
    """Steady motions at one frequency."""

    frequency: FREQUENCY


class Collision(WithDamper):
    """Shares of random starts that lead to a collision, including starts beyond the walls."""

    frequency: FREQUENCY


class Optimum(keys_of(DAMPER, needed=NEEDED, without=["clearance", COMMON]), WithOscillator):
    """Sweeps of the clearance at one frequency, each with its optimum."""

    frequency: FREQUENCY
    clearances: range_of(CLEARANCE)
    starts: starts_of("at each clearance, in place of `search.sweep_starts`") = None

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        runs = (self.starts or 0) * config.points.clearances
        if runs > MOST_RUNS:
            reason = f"with points.clearances makes {runs}: must be at most {MOST_RUNS} in all"
            yield problem((*path, "starts"), self.starts, f"{reason} (a job keeps them in memory)")


class Migration(WithDamper):
    """Cases of migration control."""

    frequency: FREQUENCY
    longest_hold: count(
        "forcing cycles after which the damper is switched off at the latest",
        **PERIODS_RANGE,
    )


class ReleaseScan(WithDamper):
    """Motions to which the oscillator settles after the damper is switched off (release)."""

    frequencies: FREQUENCIES
    lifetime: count(
        "forcing cycles within which motions that have not settled are released",
        **SCAN_LIFETIME_RANGE,
    )


class Basins(MaybeWithDamper):
    """Planes of states of the primary mass, and the motions to which they lead."""

    frequency: FREQUENCY
    displacement: number("half width of the plane in Z1", above=0, most=FARTHEST)
    velocity: number("half width of the plane in Z1'", above=0, most=FASTEST)
    cells: count("states on each axis of the plane", least=2, most=10**4)


class PolicyDamper(keys_of(DAMPER, needed=NEEDED, without=[COMMON])):
    """One of the dampers to compare."""


class ReleasePolicies(WithOscillator):
    """Policies of migration compared for several dampers, over frequency."""

    dampers: entries(PolicyDamper)
    frequencies: several(FREQUENCY, "increasing forcing frequencies", least=1, distinct=True)
    trials: count("trials of each policy", **RUNS_RANGE)
    tested: count("releases that test which states are predicted to lead to the goal", **RUNS_RANGE)
    cells: count("cells on each axis of the coarse grid of a basin", least=4, most=4096)

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from increasing((*path, "frequencies"), self.frequencies, "frequencies of a curve")


SECTIONS = {
    "curves": Curve,
    "motion": Motion,
    "collisions": Collision,
    "optimum": Optimum,
    "migration": Migration,
    "release_scan": ReleaseScan,
    "basins": Basins,
    "release_policies": ReleasePolicies,
}
