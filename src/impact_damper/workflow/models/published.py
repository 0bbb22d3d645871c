"""Published numbers and closed forms with which results of this package are compared."""

from typing import ClassVar

from impact_damper.system.bounds import MOST_RUNS
from impact_damper.workflow.models.messages import problem
from impact_damper.workflow.models.section import Section, increasing
from impact_damper.workflow.models.system import (
    CONTACT_STIFFNESS,
    FREQUENCY,
    MASS_RATIO,
    RESTITUTION,
)
from impact_damper.workflow.models.values import count, number, several

DAMPING_RATIO = number("damping ratio", least=1e-5, most=0.5)
GAP = number("full gap in static deflections", above=0, most=1000)
FORCE = number("force, with unit stiffnesses", above=0, most=0.05)
SPRING = number("cubic coefficient, negative for softening", least=-1, most=1)
SPEED = number("speed before the impact, m/s", above=0, most=10)
FALLING = "falling; orders are observed between neighbours"


class RigidWalls(Section):
    """The symmetric motion with two impacts, in all combinations of the lists."""

    damping_ratio: DAMPING_RATIO
    restitutions: several(RESTITUTION, least=1, distinct=True)
    mass_ratios: several(MASS_RATIO, least=1, distinct=True)
    gaps: several(GAP, least=1, distinct=True)
    frequencies: several(FREQUENCY, least=1, distinct=True)
    stiffnesses: several(CONTACT_STIFFNESS, "r1 of ours, increasing", least=2)

    counts: ClassVar = ("restitutions", "mass_ratios", "gaps", "frequencies", "stiffnesses")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from increasing((*path, "stiffnesses"), self.stiffnesses, "the limit is rigid walls")


class Falling(Section):
    """Base of groups with falling mass ratios."""

    mass_ratios: several(MASS_RATIO, FALLING, least=2)

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from decreasing((*path, "mass_ratios"), self.mass_ratios)


class VibroImpact(Falling):
    """Thresholds and optimum of the vibro-impact absorber."""

    restitution: RESTITUTION
    damping_share: number("damping ratio over mass ratio", above=0, most=10)
    contact_stiffness: CONTACT_STIFFNESS


class RingDown(Falling):
    """Unforced decays with the vibro-impact absorber."""

    restitution: RESTITUTION
    contact_stiffness: CONTACT_STIFFNESS


class TunedMassDampers(Section):
    """Tuned mass dampers."""

    mass_ratios: several(MASS_RATIO, least=1, distinct=True)


class NonlinearAbsorbers(Section):
    """Nonlinear absorbers."""

    mass_ratio: MASS_RATIO
    forces: several(FORCE, least=1, distinct=True)


class BasinShares(Section):
    """Basin shares of the oscillator with five motions."""

    starts: count("random starts", least=1, most=MOST_RUNS)


class JumpFrequencies(Section):
    """Jumps of the oscillator without a damper."""

    springs: several(SPRING, least=1, distinct=True)
    damping_ratios: several(DAMPING_RATIO, least=1, distinct=True)
    peak: number("force over damping ratio", above=0, most=1)


class HertzImpacts(Section):
    """Impacts of a steel ball."""

    speeds: several(SPEED, least=1, distinct=True)


class Published(Section):
    """Groups of published numbers."""

    rigid_walls: RigidWalls
    vibro_impact: VibroImpact
    ring_down: RingDown
    tuned_mass_dampers: TunedMassDampers
    nonlinear_absorbers: NonlinearAbsorbers
    basin_shares: BasinShares
    jump_frequencies: JumpFrequencies
    hertz_impacts: HertzImpacts


def decreasing(path, values):
    """Yield a line unless a list decreases."""
    if sorted(set(values), reverse=True) != values:
        yield problem(path, values, f"must decrease ({FALLING})")


SECTIONS = {"published": Published}
