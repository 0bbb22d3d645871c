"""Every plot takes what the public functions return, draws it, and refuses anything else."""

import subprocess
import sys

import matplotlib
import numpy as np
import pytest
import xarray as xr
from helpers.made_up_design import made_up_design
from matplotlib.figure import Figure

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.plot.drawing import looks

matplotlib.use("Agg")

OSCILLATOR, DAMPER = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.02, force=40)
MACHINE_DAMPER = MACHINE.damper(mass=0.6, gap="3 mm", contact_stiffness=2e7)
QUIET = (0.006, 0.187, 0.002, -2.408)
FREQUENCIES = [1.9, 2.0, 2.1]


@pytest.fixture(autouse=True)
def no_figures_left():
    yield
    matplotlib.pyplot.close("all")


@pytest.fixture(scope="module")
def results():
    quiet = idm.steady_motion(OSCILLATOR, DAMPER, 2.0, QUIET)
    return {
        "quiet": quiet,
        "steady": [quiet, idm.steady_motion(OSCILLATOR, DAMPER, 2.05, quiet.state)],
        "still": idm.steady_motion(OSCILLATOR, DAMPER, 2.0),
        "run": idm.simulate(OSCILLATOR, DAMPER, 2.0, quiet.state, periods=3),
        "orbit": idm.periodic_orbit(OSCILLATOR, DAMPER, 2.0, quiet.state),
        "branch": idm.orbit_branch(OSCILLATOR, DAMPER, 2.0, quiet.state, span=(1.95, 2.05)),
        "over_gap": idm.orbit_branch(
            OSCILLATOR, DAMPER, 2.0, quiet.state, span=(1.8, 2.2), parameter="clearance"
        ),
        "response": idm.frequency_response(OSCILLATOR, DAMPER, FREQUENCIES, starts=6),
        "free": idm.frequency_response(OSCILLATOR, None, FREQUENCIES, starts=6),
        "balance": idm.harmonic_balance_response(OSCILLATOR, DAMPER, np.linspace(1.5, 2.5, 21)),
        "band": idm.suppression_band(OSCILLATOR, DAMPER),
        "sweep": idm.clearance_sweep(
            OSCILLATOR, {"mass_ratio": 0.12}, 2.0, [1.8, 2.0, 2.2, 2.4], starts=4
        ),
        "migration": idm.migrate(OSCILLATOR, DAMPER, 1.95, periods=200),
        "basins": idm.basins(OSCILLATOR, None, 1.8, cells=30),
        "machine_steady": idm.steady_motion(MACHINE, MACHINE_DAMPER, 21.0, (0, 0.1, 0.001, 0.3)),
        "design": made_up_design(),
        "machine_response": idm.frequency_response(MACHINE, None, [19.0, 20.0], starts=3),
    }


DRAWN = [
    ("response", ["response"]),
    ("response", ["free"]),
    ("response", ["balance"]),
    ("response", ["band"]),
    ("response", ["branch"]),
    ("response", ["still"]),
    ("response", ["machine_response"]),
    ("response", ["response", "free", "balance", "band", "branch", "quiet", "still"]),
    ("branch", ["branch"]),
    ("branch", ["over_gap", "over_gap"]),
    ("orbit", ["run"]),
    ("orbit", ["quiet"]),
    ("orbit", ["orbit"]),
    ("orbit", ["machine_steady"]),
    ("sweep", ["sweep"]),
    ("sweep", ["sweep", "sweep"]),
    ("shares", ["response"]),
    ("shares", ["sweep"]),
    ("migration", ["migration"]),
    ("basins", ["basins"]),
    ("design", ["design"]),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("name", "keys"), DRAWN)
def test_results_are_drawn_with_labelled_axes(name, keys, results):
    data = [results[key] for key in keys]
    found = getattr(idm.plot, name)(data[0] if len(data) == 1 else data)
    for axes in np.ravel(np.array(found, object)):
        assert axes.get_xlabel() and axes.get_ylabel()
        assert axes.lines or axes.patches or axes.collections
        labels = [text.get_text() for text in axes.get_legend().get_texts()] if axes.legend_ else []
        assert len(labels) == len(set(labels))
    np.ravel(np.array(found, object))[0].figure.canvas.draw()


@pytest.mark.parametrize(("name", "keys"), [DRAWN[0], DRAWN[8], DRAWN[11], DRAWN[14], DRAWN[18]])
def test_given_axes_are_drawn_on(name, keys, results):
    panels = Figure().subplots(1, 2)
    ax = panels if name == "orbit" else panels[0]
    found = getattr(idm.plot, name)(results[keys[0]], ax=ax)
    assert np.all(np.ravel(np.array(found, object)) == np.ravel(ax))
    with pytest.raises(TypeError, match="ax = .*: must be . Axes"):
        getattr(idm.plot, name)(results[keys[0]], ax=3)


@pytest.mark.parametrize(
    "name", ["response", "branch", "orbit", "sweep", "shares", "migration", "basins", "design"]
)
@pytest.mark.parametrize("wrong", [None, 3, [], {}, "response", [3], xr.Dataset()])
def test_anything_else_is_refused(name, wrong):
    with pytest.raises(TypeError, match="data = .*: must be a result of"):
        getattr(idm.plot, name)(wrong)


def test_results_of_different_machines_are_not_mixed(results):
    with pytest.raises(TypeError, match="of one machine, or all dimensionless"):
        idm.plot.response([results["free"], results["machine_response"]])


def test_a_plot_shows_the_numbers_of_its_dataset(results):
    axes = idm.plot.response(results["steady"])
    (line,) = [each for each in axes.lines if each.get_label() == "settled"]
    np.testing.assert_allclose(line.get_xdata(), [2.0, 2.05])
    expected = [float(each.maximum_displacement) for each in results["steady"]]
    np.testing.assert_allclose(line.get_ydata(), expected)


def test_an_orbit_in_si_units_is_closed(results):
    phase, _ = idm.plot.orbit(results["machine_steady"])
    x, v = phase.lines[0].get_data()
    np.testing.assert_allclose([x[0], v[0]], [x[-1], v[-1]], atol=1e-4 * np.ptp(x))


def test_shares_add_up(results):
    """The areas are stacked, and the lowest area is the motion of period 1."""
    axes = idm.plot.shares(results["response"])
    below = 0
    for area in axes.patches:
        top, _, bottom = area.get_data()
        np.testing.assert_allclose(bottom, below)
        below = top
    np.testing.assert_allclose(below, 1)
    response = results["response"]
    quiet = (response.period == 1) & (response.outcome == flag("outcome", "settled"))
    share = response.motion_starts.where(quiet, 0).sum("motion") / response.sizes["start"]
    assert axes.patches[0].get_label() == "period 1"
    np.testing.assert_allclose(axes.patches[0].get_data().values, share)


def test_shares_of_a_single_frequency(results):
    axes = idm.plot.shares(results["response"].isel(frequency=[1]))
    assert axes.get_xlim() == pytest.approx((1.9, 2.1))


def test_a_design_shows_its_gap_and_the_starts_that_end_quiet(results):
    response, sizes, shares = idm.plot.design(results["design"])
    for axes in (sizes, shares):
        (gap,) = [each for each in axes.lines if each.get_label() == "gap to build"]
        np.testing.assert_array_equal(gap.get_xdata(), 7.0)
    (candidates,) = [each for each in shares.containers if each.get_label() == "candidates"]
    np.testing.assert_array_equal(candidates.lines[0].get_xdata(), [6, 7, 8, 9])
    expected = results["design"]["start_quiet_share"].min("frequency")
    np.testing.assert_array_equal(candidates.lines[0].get_ydata(), expected)


@pytest.mark.thorough
def test_the_package_starts_without_matplotlib():
    code = "import sys, impact_damper as idm; idm.Oscillator, idm.simulate; 'plot' in dir(idm)"
    code += "; assert 'matplotlib' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_backend_that_becomes_interactive_stays_so():
    """The backend of notebooks becomes interactive with the first figure, and must remain so.

    Otherwise a notebook would show only the first figure.
    """
    before = matplotlib.is_interactive()
    try:
        with looks(None):
            matplotlib.interactive(True)
        assert matplotlib.is_interactive()
    finally:
        matplotlib.interactive(before)
