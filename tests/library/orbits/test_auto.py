"""Folds and losses of symmetry of the oscillator without a damper, compared with AUTO-07p."""

import pandas as pd
import pytest
from numpy.testing import assert_allclose
from references.auto import folds

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Oscillator
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit

pytestmark = pytest.mark.thorough

STORED = pd.read_csv(folds.HERE / "folds.csv", comment="#").to_dict("records")
BRANCHES = {"response": (folds.RESPONSE, (0.6, 4.0)), "subharmonic": (folds.SUBHARMONIC, (1, 4))}


def stored(damping, branch):
    """Return AUTO's points of a branch, sorted by increasing frequency."""
    chosen = [p for p in STORED if (p["damping"], p["branch"]) == (damping, branch)]
    return sorted(chosen, key=lambda point: point["frequency"])


def followed(damping, branch):
    """Return the branch that this package follows from AUTO's first orbit."""
    (periods, frequency, starts), span = BRANCHES[branch]
    state = folds.first_orbit(damping, frequency, starts[damping], periods)[0, 1:3]

    def family(value):
        return pack(Oscillator(damping), None, value)

    orbit = find_orbit(family(frequency), [*state, *state], periods, phase=0.0)
    return follow_branch(family, orbit, frequency, span)


@pytest.mark.skipif(folds.missing() is not None, reason=str(folds.missing()))
@pytest.mark.parametrize("run", folds.RUNS)
def test_auto_finds_the_stored_points(tmp_path, run):
    branch, *_, kinds, settings = folds.RUNS[run]
    folds.build(tmp_path)
    found = folds.found_in(tmp_path, 0.215, run, settings[:1])
    found.sort(key=lambda point: point["frequency"])
    expected = [p for p in stored(0.215, branch) if kinds is None or p["kind"] in kinds]
    assert [point["kind"] for point in found] == [point["kind"] for point in expected]
    for point, other in zip(found, expected, strict=True):
        error = 2 * other["frequency_error"]
        assert_allclose(point["frequency"], other["frequency"], rtol=0, atol=error)
        assert_allclose(point["maximum_displacement"], other["maximum_displacement"], rtol=1e-6)


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize("damping", folds.DAMPINGS[::2])
def test_continuation_finds_the_points_of_auto(damping, branch):
    """The package finds AUTO's points. The frequencies of folds agree to 1e-10."""
    own = followed(damping, branch)
    assert own.lost == 0
    events = sorted((event for _, event in own.events), key=lambda event: event.point.value)
    expected = stored(damping, branch)
    assert [event.kind for event in events] == [point["kind"] for point in expected]
    for event, point in zip(events, expected, strict=True):
        error = 2 * point["frequency_error"]
        assert_allclose(event.point.value, point["frequency"], rtol=0, atol=error)
        record = event.point.orbit.record
        assert_allclose(record["maximum_displacement"], point["maximum_displacement"], rtol=1e-6)
