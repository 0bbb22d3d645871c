"""Published numbers and closed forms with which results of this package ("ours") are compared."""

from typing import ClassVar

from chatterjee1995.workflow.models.system import (
    CONTACT_STIFFNESS,
    FREQUENCY,
    MASS_RATIO,
    RESTITUTION,
)
from impact_damper.command.messages import problem
from impact_damper.command.section import Section, increasing
from impact_damper.command.values import count, number, several
from impact_damper.model.bounds import MOST_RUNS

DAMPING_RATIO = number("damping ratio", least=1e-5, most=0.5)
GAP = number("full gap in static deflections", above=0, most=1000)
FORCE = number("force, with unit stiffnesses", above=0, most=0.05)
SPRING = number("cubic coefficient, negative for softening", least=-1, most=1)
SPEED = number("speed before the impact, m/s", above=0, most=10)
FALLING = "falling; each pair of neighbours gives an order of convergence"


class RigidWalls(Section):
    """The symmetric motion with two impacts in a cycle, for all combinations of the lists."""

    damping_ratio: DAMPING_RATIO
    restitutions: several(RESTITUTION, "values of e", least=1, distinct=True)
    mass_ratios: several(MASS_RATIO, "values of rm", least=1, distinct=True)
    gaps: several(GAP, "full gaps in static deflections", least=1, distinct=True)
    frequencies: several(FREQUENCY, "forcing over natural frequency", least=1, distinct=True)
    stiffnesses: several(CONTACT_STIFFNESS, "r1 of our contact, increasing", least=2)

    counts: ClassVar = ("restitutions", "mass_ratios", "gaps", "frequencies", "stiffnesses")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from increasing((*path, "stiffnesses"), self.stiffnesses, "the limit is rigid walls")


class Falling(Section):
    """Base of the groups that compare formulas of first order in the mass ratio."""

    mass_ratios: several(MASS_RATIO, FALLING, least=2)

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from decreasing((*path, "mass_ratios"), self.mass_ratios)


class VibroImpact(Falling):
    """Thresholds and optimum of the vibro-impact absorber, a loose mass between rigid walls."""

    restitution: RESTITUTION
    damping_share: number("damping ratio over mass ratio", above=0, most=10)
    contact_stiffness: CONTACT_STIFFNESS


class RingDown(Falling):
    """Unforced decays with the vibro-impact absorber."""

    restitution: RESTITUTION
    contact_stiffness: CONTACT_STIFFNESS


class TunedMassDampers(Section):
    """Tuned mass dampers: a spring and a dashpot hold the additional mass."""

    mass_ratios: several(MASS_RATIO, "values of rm", least=1, distinct=True)


class NonlinearAbsorbers(Section):
    """Tuned mass dampers with an additional cubic spring."""

    mass_ratio: MASS_RATIO
    forces: several(FORCE, "forces, with unit stiffness", least=1, distinct=True)


class BasinShares(Section):
    """Shares of random starts that lead to each motion of an oscillator with five motions."""

    starts: count("random starts", least=1, most=MOST_RUNS)


class JumpFrequencies(Section):
    """Frequencies at which the response of the oscillator without a damper jumps."""

    springs: several(SPRING, "cubic coefficients, negative: softening", least=1, distinct=True)
    damping_ratios: several(DAMPING_RATIO, "damping ratios", least=1, distinct=True)
    peak: number("force over damping ratio", above=0, most=1)


class HertzImpacts(Section):
    """Impacts of a steel ball, by Hertz's law and by the linear contact of this package."""

    speeds: several(SPEED, "speeds before the impact, m/s", least=1, distinct=True)


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
