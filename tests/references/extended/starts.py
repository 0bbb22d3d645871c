"""Random systems and initial states for the comparison of the kernels with 80-bit arithmetic."""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    FREQUENCY,
    INVERSE_MASS_RATIO,
    pack,
)
from impact_damper.model.parameters import Damper, Oscillator, parameters_in, pick
from references import extended

PERIODS = 2  # forcing cycles of a run
FAR = 1e3  # a clearance that no motion reaches

# USUAL: ranges of the parameters. KINDS: kind of start -> ranges that replace ranges in USUAL.
# A range whose ends have a ratio above 3 is drawn uniformly in the logarithm.
USUAL = {
    "damping": (0.02, 0.4),
    "linear_frequency": (0.0, 0.0),
    "mass_ratio": (0.05, 0.6),
    "clearance": (0.3, 3.0),
    "contact_stiffness": (300.0, 5000.0),
    "restitution": (0.5, 0.98),
    "frequency": (0.8, 3.0),
}
KINDS = {
    "usual": {},
    "soft walls": {"contact_stiffness": (1.0, 100.0)},
    "stiff walls": {"contact_stiffness": (1e4, 1e6)},
    "light mass": {"mass_ratio": (0.002, 0.05)},
    "heavy mass": {"mass_ratio": (1.0, 10.0)},
    "slow forcing": {"frequency": (0.3, 0.8)},
    "fast forcing": {"frequency": (4.0, 40.0)},
    "linear stiffness": {"linear_frequency": (0.3, 5.0)},
    "dead contacts": {"restitution": (0.05, 0.4)},
    "grazing": {},
    "in contact": {"contact_stiffness": (10.0, 1e5)},
    "on a wall": {"contact_stiffness": (10.0, 1e5)},
    "linear spring": {"linear_frequency": (0.3, 5.0), "cubic": (0.0, 0.0)},
    # The barriers of these springs are higher than the energy of any start, because an escape would
    # take ever shorter steps.
    "softening spring": {"linear_frequency": (2.0, 4.0), "cubic": (-0.05, 0.0)},
    "other forces": {"cubic": (0.1, 10.0), "force": (0.1, 10.0), "unbalance": (0.1, 3.0)},
    "no force": {"linear_frequency": (0.0, 2.0), "force": (0.0, 0.0)},
    "moving base": {"linear_frequency": (0.3, 2.0), "cubic": (0.1, 1.0), "base": (0.5, 1.0)},
    "gravity": {"gravity": (0.05, 2.0)},
    "walls that never pull": {"restitution": (0.05, 0.9), "gravity": (-0.5, 0.5)},
    "narrow gap, never pull": {"clearance": (0.02, 0.1), "restitution": (0.3, 0.9)},
}
# Each other parameter of the oscillator gets a kind in which only this parameter is added.
_DRAWN = set(USUAL).union(*KINDS.values())
KINDS |= {
    each.name: {each.name: (0.1, 3.0)}
    for each in parameters_in(Oscillator)
    if each.name not in _DRAWN
}


class Starts(NamedTuple):
    """Packed parameters (m, COUNT), states (m, 4), start times (m,), and end times (m, PERIODS)."""

    parameters: np.ndarray
    states: np.ndarray
    starts: np.ndarray
    times: np.ndarray


def _draw(random, bounds):
    """Return a random number within bounds."""
    low, high = bounds
    if high > 3 * low > 0:
        return math.exp(random.uniform(math.log(low), math.log(high)))
    return random.uniform(low, high)


def _parameters(random, ranges, elastic, rule):
    """Return random packed parameters from ranges by name."""
    drawn = {name: _draw(random, bounds) for name, bounds in ranges.items()}
    if elastic:
        drawn["restitution"] = 1.0
    oscillator = Oscillator(**pick(Oscillator, drawn))
    damper = Damper(**pick(Damper, drawn), exit_rule=rule)
    return pack(oscillator, damper, drawn["frequency"])


def _graze(random, p, state, start, end):
    """Shift Z2 such that, without walls, an extremum of Z2 would be 1e-13 to 1e-2 from a wall."""
    unbounded = p.copy()
    unbounded[CLEARANCE] = FAR
    turnings = extended.run(unbounded, state, start, [end]).turnings[:-1]
    depth = random.choice((-1, 1)) * 10 ** random.uniform(-13, -2)
    for turning in random.permutation(turnings):
        z = turning[1] * (turning[2] + FAR)
        for wall in (-1, 1):
            shifted = float(state[2] + wall * (p[CLEARANCE] + depth) - z)
            if abs(shifted) < p[CLEARANCE]:
                state[2] = shifted
                return


def draw(kind, count, seed):
    """Return `count` starts of one kind, alternately with elastic and inelastic contact.

    Z1 is uniform in (-2, 2), Z1' in (-3, 3), Z2' in (-4, 4), Z2 over the gap. Three kinds differ:
    "grazing": an extremum of Z2 lies 1e-13 to 1e-2 inside or beyond a wall. "in contact": Z2 lies
    beyond a wall, by the penetration that stops a speed of 0.01 to 30. "on a wall": Z2 is exactly
    the clearance, with Z2' = 0 or a speed of 1e-8 to 4, outward or inward.
    """
    random = np.random.default_rng([seed, list(KINDS).index(kind)])
    return Starts(
        *map(np.array, zip(*(_start(random, kind, i) for i in range(count)), strict=True))
    )


def _start(random, kind, index):
    """Return one row of `Starts`."""
    rule = "no_tension" if "never pull" in kind else "zero_penetration"
    p = _parameters(random, USUAL | KINDS[kind], index % 2 == 0, rule)
    period = 2 * math.pi / p[FREQUENCY]
    start = random.uniform(0, period)
    times = start + period * np.arange(1, PERIODS + 1)
    y = random.uniform(-1, 1, 4) * (2, 3, p[CLEARANCE], 4)
    wall = random.choice((-1, 1))
    if kind == "grazing":
        _graze(random, p, y, start, times[-1])
    elif kind == "in contact":
        speed = 10 ** random.uniform(-2, 1.5)
        natural = math.sqrt(p[CONTACT_STIFFNESS] * (1 + p[INVERSE_MASS_RATIO]))
        y[2] = wall * (p[CLEARANCE] + speed / natural)
    elif kind == "on a wall":
        speed = random.choice((0.0, 1.0), p=(0.1, 0.9)) * 10 ** random.uniform(-8, 0.6)
        y[2:] = wall * p[CLEARANCE], random.choice((-1, 1)) * speed
    return p, y, start, times
