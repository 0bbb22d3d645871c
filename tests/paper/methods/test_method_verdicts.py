"""Verdicts: the truth of a scene compared with heyoka, and the rule on made-up states.

A scene is a start near an orbit. Its truth is whether the motion stays on this orbit.
"""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from numpy.testing import assert_allclose

from chatterjee1995.methods import method_verdicts as judged
from chatterjee1995.tables.integrators import SHOWN
from chatterjee1995.tables.integrators import method_verdicts as verdict_table
from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper

QUIET = dict(
    near=(0.0057, 0.1874, 0.0019, -2.4079),
    period=1,
    offset=(1e-3, 0, 0, 0),
    periods=100,
    orbit_frequency=2.0,
    scipy_every=0,
)
FOLD = dict(
    near=(2.37021, 0.2287, 2.37021, 0.2287),
    period=1,
    offset=(0, 0, 0, 0),
    periods=200,
    orbit_frequency=2.0143,
    scipy_every=0,
)


def test_settled_period_of_made_up_states():
    k = np.arange(60)
    spiral = 0.8**k * np.cos(k)
    states = np.zeros((60, 4))
    states[:, 0] = spiral
    assert judged.settled_period(states) == 1
    states[:, 0] = spiral + (k % 3 == 0)
    assert judged.settled_period(states) == 3
    states[:, 0] = np.cos(k)
    assert judged.settled_period(states) == 0


def test_first_index_from_which_all_are_right():
    assert judged.right_from(np.array([True, True])) == 0
    assert judged.right_from(np.array([False, True, False, True])) == 3
    assert judged.right_from(np.array([True, False])) == 2


@pytest.mark.parametrize(
    ("damper", "frequency", "given", "stays"),
    [(DESIGN, 2.0, QUIET, True), (None, 2.0143, FOLD, True), (None, 2.0146, FOLD, False)],
    ids=["quiet", "before the fold", "after the fold"],
)
def test_truth_agrees_with_heyoka(damper, frequency, given, stays, heyoka_references):
    scene = judged.make_scene(PAPER, damper, frequency, **given)
    assert scene.stays == stays
    begin = 0.5 * math.pi / frequency
    times = begin + 2 * math.pi / frequency * np.arange(1, scene.periods + 1)
    states = heyoka_references[0].run(scene.parameters, scene.start, begin, times).states
    assert judged.is_on(states, scene.orbit[None, :2], scene.period) == stays
    assert judged.judge(states, scene) == "right"


def test_both_sides_of_symmetry_breaking():
    damper = Damper(0.25, 1.0)
    near = (0.0522, 0.5544, -0.0254, -0.5175)
    given = dict(near=near, period=1, offset=(1e-3, 0, 0, 0), periods=150, scipy_every=0)
    before = judged.make_scene(PAPER, damper, 1.249, orbit_frequency=1.249, **given)
    after = judged.make_scene(PAPER, damper, 1.245, orbit_frequency=1.245, **given)
    assert before.multiplier < 1 < after.multiplier
    assert before.stays and not after.stays


def test_verdicts_of_the_taylor_series_and_of_coarse_steps():
    scenes = {"quiet": judged.make_scene(PAPER, DESIGN, 2.0, **QUIET)}
    data = judged.verdicts(scenes, [1e-9, 1e-6], [20, 40])
    right = data.verdict.sel(verdict_method="taylor") == flag("verdict", "right")
    assert right.all()
    assert_allclose(data.right_from.sel(verdict_method="taylor"), 1e-6)
    failed = data.verdict.sel(verdict_method="heun") == flag("verdict", "failed")
    assert failed.all()
    not_run = data.verdict.sel(verdict_method="LSODA") == flag("verdict", "not_run")
    assert not_run.all()
    row = verdict_table({"method_verdicts": {"one": data}}).iloc[0]
    assert SHOWN["method_verdicts"].keys() <= set(row.index)
    assert (row["taylor"], row["heun"], row["LSODA"]) == (1e-6, "never right", "not run")
    data.verdict.loc["quiet", "heun", 1e-6] = flag("verdict", "right")
    row = verdict_table({"method_verdicts": {"one": data}}).iloc[0]
    assert row["heun"] == "not at the strictest"


def test_an_orbit_that_does_not_exist_is_refused():
    with pytest.raises(ValueError, match="there is no orbit of period 1"):
        judged.make_scene(PAPER, DESIGN, 2.0, **(QUIET | {"near": (0, 3.0, 0, 0)}))
