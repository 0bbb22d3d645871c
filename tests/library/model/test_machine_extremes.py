"""Extreme machines and dampers: every motion ends within its limit of forcing cycles."""

import math
from itertools import cycle

import numpy as np
import pytest
from scipy.stats import qmc

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.model.bounds import CLEARANCE_RANGE

SHORT = idm.Settling(patience=100, limit=100, watched=2, further=0)
OUTCOMES = [
    flag("outcome", name)
    for name in "unresolved settled chaotic non_colliding escaped at_rest drifting".split()
]
MASS, STIFFNESS, FORCE = 12.0, 2e5, 40.0
SPRINGS = {"linear": 0.0, "hardening": 4e9, "softening": -4e9}
# Ends of the ranges. The gap is a number from 0, the least gap, to 1, the largest gap.
ENDS = {
    "mass_ratio": (1e-4, 1.0),
    "gap": (0.0, 1.0),
    "restitution": (0.05, 1.0),
    "stiffness_ratio": (1.0, 1e6),
    "damping_ratio": (1e-5, 0.5),
}
# With contacts more than FAST times as fast as the machine a forcing cycle takes half a second.
FAST = 1e3


def extreme(spring, mass_ratio, gap, restitution, stiffness_ratio, damping_ratio):
    """Return a machine and its damper, the gap being at least the penetration of the contact."""
    machine = idm.Machine(
        mass=MASS,
        linear_stiffness=STIFFNESS,
        cubic_stiffness=SPRINGS[spring],
        damping_ratio=damping_ratio,
        force=FORCE,
    )
    share = mass_ratio / (1 + mass_ratio)
    static = FORCE / STIFFNESS
    play = 1.001 * 2 * share * static / stiffness_ratio
    # Penetration in an impact at the speed (static deflection) times (natural angular frequency).
    penetration = static * math.sqrt(share / stiffness_ratio)
    bounds = machine.scales.range_to_si(CLEARANCE_RANGE, "clearance")
    least = max(play, 2 * penetration, 2.001 * bounds["least"])
    most = min(2000 * static, 1.999 * bounds["most"])
    damper = machine.damper(
        mass=mass_ratio * MASS,
        gap=least ** (1 - gap) * most**gap,
        restitution=restitution,
        contact_stiffness=stiffness_ratio * STIFFNESS,
    )
    return machine, damper


def drawn(count):
    """Return extremes drawn together; a third of the values are ends of their range."""
    rows = qmc.LatinHypercube(len(ENDS), rng=18).random(count)
    levels = np.clip(1.5 * rows - 0.25, 0, 1)
    linear = np.array([name in ("gap", "restitution") for name in ENDS])
    first, last = np.array(list(ENDS.values())).T
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.where(linear, first + (last - first) * levels, first * (last / first) ** levels)
    return [dict(zip(ENDS, row, strict=True)) for row in values]


def named(given):
    if isinstance(given, str):
        return given
    return "-".join(f"{name}={value:.3g}" for name, value in given.items())


def assert_ends(spring, given):
    machine, damper = extreme(spring, **given)
    frequency, static = machine.natural_frequency, FORCE / STIFFNESS
    speed = 5 * static * 2 * math.pi * machine.natural_frequency
    for state in ((static, 0, 0, 0), (0, 0, 0, speed)):
        steady = idm.steady_motion(machine, damper, frequency, state, settling=SHORT)
        outcome = int(steady["outcome"])
        assert outcome in OUTCOMES
        assert int(steady["periods_run"]) <= SHORT.limit
        if outcome != flag("outcome", "escaped"):
            assert np.isfinite(steady["maximum_displacement"])


def assert_a_period_ends(spring, given):
    machine, damper = extreme(spring, **given)
    frequency = machine.natural_frequency
    motion = idm.simulate(machine, damper, frequency, (0, 0, 0, 0.1), periods=1)
    assert float(motion["time"][-1]) == pytest.approx(1 / frequency, rel=1e-9)
    escaped = "escape_time" in motion and np.isfinite(motion["escape_time"])
    assert escaped or np.isfinite(motion["displacement"]).all()


@pytest.mark.parametrize(
    ("spring", "given"), list(zip(cycle(SPRINGS), drawn(36), strict=False)), ids=named
)
def test_extremes_together_end_in_an_outcome(spring, given):
    """With a slow contact a run ends within its limit. With a fast one a run of one cycle ends."""
    speed = math.sqrt(given["stiffness_ratio"] * (1 + 1 / given["mass_ratio"]))
    if speed < FAST:
        assert_ends(spring, given)
    else:
        assert_a_period_ends(spring, given)
