"""Every plot takes what the public functions return, draws it, and refuses anything else."""

import matplotlib
import numpy as np
import pytest
import xarray as xr
from helpers.made_up import matched_sweep
from helpers.made_up_design import made_up_design
from matplotlib.figure import Figure

import impact_damper as idm
from impact_damper.data.datasets import dataset
from impact_damper.data.motion_variables import OUTCOME
from impact_damper.plot.sheets import sheet

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
        "branch": idm.orbit_branches(OSCILLATOR, DAMPER, 2.0, quiet.state, span=(1.95, 2.05)),
        "over_gap": idm.orbit_branches(
            OSCILLATOR, DAMPER, 2.0, quiet.state, span=(1.8, 2.2), parameter="clearance"
        ),
        "response": idm.frequency_response(OSCILLATOR, DAMPER, FREQUENCIES, starts=6),
        "free": idm.frequency_response(OSCILLATOR, None, FREQUENCIES, starts=6),
        "balance": idm.harmonic_balance(OSCILLATOR, DAMPER, np.linspace(1.5, 2.5, 21)),
        "sweep": idm.clearance_sweep(
            OSCILLATOR, {"mass_ratio": 0.12}, 2.0, [1.8, 2.0, 2.2, 2.4], starts=4
        ),
        "migration": idm.migrate(OSCILLATOR, DAMPER, 1.95, periods=200),
        "basins": idm.basins(OSCILLATOR, None, 1.8, cells=30),
        "machine_run": idm.simulate(MACHINE, MACHINE_DAMPER, 21.0, (0, 0.1, 0.001, 0.3)),
        "design": made_up_design(),
        "machine_response": idm.frequency_response(MACHINE, None, [19.0, 20.0], starts=3),
    }


DRAWN = [
    ("response", ["free"]),
    ("response", ["balance"]),
    ("response", ["branch"]),
    ("response", ["still"]),
    ("response", ["machine_response"]),
    ("response", ["response", "free", "balance", "branch", "quiet", "still"]),
    ("branch", ["branch"]),
    ("branch", ["over_gap", "over_gap"]),
    ("orbit", ["run"]),
    ("orbit", ["machine_run"]),
    ("sweep", ["sweep", "sweep"]),
    ("shares", ["response"]),
    ("migration", ["migration"]),
    ("basins", ["basins"]),
    ("design", ["design"]),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("name", "keys"), DRAWN)
def test_results_are_drawn_with_labelled_axes_and_a_legend(name, keys, results):
    data = [results[key] for key in keys]
    found = getattr(idm.plot, name)(data[0] if len(data) == 1 else data)
    panels = list(np.ravel(np.array(found, object)))
    for axes in panels:
        assert axes.get_xlabel() and axes.get_ylabel()
        assert axes.lines or axes.patches or axes.collections
    drawn = panels[0].figure
    drawn.canvas.draw()
    (legend,) = [*drawn.legends, *(axes.legend_ for axes in panels if axes.legend_)]
    labels = [text.get_text() for text in legend.get_texts()]
    assert labels and len(labels) == len(set(labels))


@pytest.mark.parametrize(("name", "key"), [("response", "response"), ("orbit", "run")])
def test_given_axes_get_each_label_once_and_no_legend(name, key, results):
    panels = Figure().subplots(1, 2)
    given = panels if name == "orbit" else panels[0]
    found = getattr(idm.plot, name)(results[key], given)
    assert np.all(np.ravel(np.array(found, object)) == np.ravel(given))
    assert not panels[0].figure.legends and panels[0].legend_ is None
    labels = panels[0].get_legend_handles_labels()[1]
    assert labels and len(labels) == len(set(labels))
    with pytest.raises(TypeError, match="axes = .*: must be . Axes"):
        getattr(idm.plot, name)(results[key], axes=3)


@pytest.mark.parametrize("name", idm.plot.__all__)
@pytest.mark.parametrize("wrong", [None, [], "response", [3], xr.Dataset()])
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


def test_labels_have_the_units_of_the_machine(results):
    phase, course = idm.plot.orbit(results["machine_run"])
    assert phase.get_xlabel().endswith("(mm)") and phase.get_ylabel().endswith("(m/s)")
    assert course.get_xlabel().endswith("(s)")
    assert idm.plot.response(results["machine_response"]).get_xlabel().endswith("(Hz)")


def test_branches_reach_to_their_ends_and_split_where_the_period_changes():
    """The branch has period 2 at W = 3. Both ends of the branch lie between two frequencies."""
    data = {
        "maximum_displacement": np.array([[9.0], [1.0], [2.0], [3.0], [9.0]]),
        "outcome": np.array([[OUTCOME["absent"]]] + 3 * [[1]] + [[OUTCOME["absent"]]]),
        "contacts": np.full((5, 1), 2.0),
        "branch": np.array([[-1], [4], [4], [4], [-1]]),
        "period": np.array([[0], [1], [1], [2], [0]]),
        "end_branch": [4, 4],
        "end_direction": [-1, 1],
        "end_value": [0.75, 3.25],
        "end_displacement": [0.5, 3.5],
    }
    made = {"mass_ratio": 0.1, "clearance": 1.0}
    axes = idm.plot.response(dataset(data, {"frequency": np.arange(5.0)}, made, "made up"))
    found = [line.get_xydata() for line in axes.lines]
    found = [line[np.isfinite(line).all(axis=1)].tolist() for line in found]
    assert found == [[[0.75, 0.5], [1, 1], [2, 2]], [[3, 3], [3.25, 3.5]]]


def test_shares_are_stacked_with_intervals():
    axes = idm.plot.shares(matched_sweep())
    quiet, chaos = axes.patches
    np.testing.assert_allclose(quiet.get_data().values, [0.5, 0.9, 0])
    np.testing.assert_allclose(quiet.get_data().edges, [0.75, 1.25, 1.75, 2.25])
    np.testing.assert_allclose(chaos.get_data().baseline, [0.5, 0.9, 0])
    np.testing.assert_allclose(chaos.get_data().values, 1)
    # The uppermost area, which ends at 1, has no interval.
    ends = [segment for lines in axes.collections for segment in lines.get_segments()]
    np.testing.assert_allclose(ends, [[[1, 0.25], [1, 0.75]], [[1.5, 0.45], [1.5, 0.95]]])


def test_chaos_of_which_a_run_ended_is_a_transient():
    data = matched_sweep()
    ends = xr.zeros_like(data["outcome"]).assign_attrs({})
    ends[2, 0] = 3
    axes = idm.plot.shares(data.assign(life_ends=ends))
    labels = [each.get_label() for each in axes.patches]
    assert labels == ["period 1", "chaotic transient", "chaotic"]
    np.testing.assert_allclose(axes.patches[1].get_data().values, [0.5, 0.9, 1])
    np.testing.assert_allclose(axes.patches[2].get_data().baseline, [0.5, 0.9, 1])


def test_a_backend_that_becomes_interactive_stays_so():
    """A notebook's backend becomes interactive with the first figure, and must remain so."""
    before = matplotlib.is_interactive()
    try:
        with sheet(None):
            matplotlib.interactive(True)
        assert matplotlib.is_interactive()
    finally:
        matplotlib.interactive(before)
