"""Runs with extreme valid parameters come to an end and return how they ended."""

import numpy as np
import pytest
from scipy.stats import qmc

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.model.parameters import parameters_in

SHORT = idm.Settling(patience=100, limit=100, watched=2, further=0)
NAMES = "unresolved settled chaotic diverged non_colliding escaped at_rest drifting".split()
OUTCOMES = [flag("outcome", name) for name in NAMES]
OF_OSCILLATOR = vars(idm.Oscillator(0.215))
USUAL = {"mass_ratio": 0.12, "clearance": 2.0, "restitution": 1.0, "contact_stiffness": 2000.0}
EXTREMES = [
    {"contact_stiffness": 1e-6},
    {"contact_stiffness": 1e9},
    {"clearance": 1e-6},
    {"clearance": 1e3},
    {"restitution": 0.05},
    {"restitution": 0.3},
    {"restitution": 1 - 1e-15},
    {"mass_ratio": 1e-6},
    {"mass_ratio": 1e-4},
    {"mass_ratio": 1.0},
    {"mass_ratio": 10.0},
    {"mass_ratio": 1e-4, "contact_stiffness": 1e6, "restitution": 0.05, "clearance": 1e3},
    {"frequency": 0.01},
    {"frequency": 1e3},
    {"damping": 1e-9},
    {"damping": 1e-5},
    {"damping": 10.0},
    {"linear_frequency": 100.0},
    {"cubic": 0.0},
    {"cubic": 0.0, "linear_frequency": 1.0},
    {"cubic": 0.0, "linear_frequency": 2.0, "damping": 1e-5},
    {"cubic": 1e6},
    {"cubic": -1e6},
    {"cubic": -1e-3, "linear_frequency": 1.0},
    {"cubic": -0.1, "linear_frequency": 1.0, "damping": 1e-5},
    {"force": 0.0},
    {"force": 0.0, "damping": 1e-5, "linear_frequency": 1.0},
    {"force": 1e6},
    {"force": 0.0, "unbalance": 1e6},
]
# Each other parameter of the oscillator is at its bounds, while all further parameters are usual.
_NAMED = set().union(*EXTREMES)
EXTREMES += [
    {each.name: each.metadata["bounds"][bound]}
    for each in parameters_in(idm.Oscillator)
    for bound in ("least", "most")
    if each.name not in _NAMED
]


# Ends of the ranges of parameters that are extreme together.
TOGETHER = {
    "mass_ratio": (1e-3, 1.0),
    "clearance": (1e-3, 1e3),
    "restitution": (0.05, 1.0),
    "contact_stiffness": (1.0, 1e5),
    "damping": (1e-5, 0.5),
}
_LEAST, _MOST = np.log(list(TOGETHER.values())).T
_LEVELS = np.clip(1.5 * qmc.LatinHypercube(len(TOGETHER), rng=18).random(16) - 0.25, 0, 1)
EXTREMES += [
    dict(zip(TOGETHER, row, strict=True)) for row in np.exp(_LEAST + (_MOST - _LEAST) * _LEVELS)
]


def system(extreme):
    """Return oscillator, damper and frequency. Parameters that are not given have usual values."""
    own = {key: extreme.get(key, usual) for key, usual in OF_OSCILLATOR.items()}
    oscillator = idm.Oscillator(**own)
    damper = idm.Damper(**USUAL | {key: extreme[key] for key in USUAL if key in extreme})
    return oscillator, damper, extreme.get("frequency", 2.0)


def named(extreme):
    return "-".join(f"{key}={value:g}" for key, value in extreme.items())


@pytest.mark.parametrize("extreme", EXTREMES, ids=named)
def test_a_motion_at_an_extreme_has_an_outcome(extreme):
    oscillator, damper, frequency = system(extreme)
    state = (1.0, 0.5, 0.0, 0.0)
    motion = idm.simulate(oscillator, damper, frequency, state, periods=2, samples=20)
    escapes = oscillator.softens and np.isfinite(motion["escape_time"])
    assert escapes or np.isfinite(motion["displacement"]).all()
    steady = idm.steady_motion(oscillator, damper, frequency, state, settling=SHORT)
    assert int(steady["outcome"]) in OUTCOMES
