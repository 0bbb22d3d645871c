"""Maps: every class of cells is drawn and named, unsettled cells are hatched, edges lie midway."""

import helpers.every_variable  # noqa: F401
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import PathPatch

from chatterjee1995.figures.balance import QUIET, VIOLENT, draw_balance_map
from chatterjee1995.figures.clearance import draw_studies
from chatterjee1995.stages.studies import AXES, OUTCOMES
from impact_damper.data.datasets import dataset
from impact_damper.data.variables import VARIABLES
from impact_damper.plot import style

pytestmark = pytest.mark.filterwarnings("error")

COLUMNS = 12


def balance_map():
    """Return a map over the restitution in which each class fills at least two columns."""
    shape = 3, COLUMNS

    def cells(values):
        return np.broadcast_to(np.resize(list(values), COLUMNS), shape)

    data = {
        "quiet_verdict": cells(VARIABLES["quiet_verdict"].flags.values()),
        "high_verdict": cells(VARIABLES["high_verdict"].flags.values()),
        "balance_quiet": cells([0] * 4 + [1] * 8),
        "balance_high": cells([1] * 6 + [0] * 6),
        "quiet_run_motion": cells([1, 3]),
        "quiet_end": np.array([[0.5, 1.0]] * 3),
        "quiet_end_event": np.array([[1, 0]] * 3),
        "straight_flight_end": np.array([0.9, 1.0, np.inf]),
    }
    coordinates = {
        "map_value": [0.8, 0.9, 1.0],
        "frequency_ratio": np.linspace(0.4, 1.5, COLUMNS),
        "edge": ["lower", "upper"],
    }
    return dataset(data, coordinates, {"parameter": "restitution"}, "made up")


@pytest.fixture(scope="module")
def drawing():
    with style.context():
        drawn = draw_balance_map(balance_map=[balance_map()])
        FigureCanvasAgg(drawn).draw()
        yield drawn


def test_every_flag_has_a_name_and_a_look_of_its_own(drawing):
    for legend, classes in zip(drawing.legends, (QUIET, VIOLENT), strict=True):
        words = [text.get_text() for text in legend.get_texts() if text.get_text()]
        assert {label for label, _, _ in classes.values()} <= set(words)
        assert len(set(words)) == len(words)
    for classes, name in ((QUIET, "quiet_verdict"), (VIOLENT, "high_verdict")):
        flags = VARIABLES[name].flags
        assert set(classes) == set(flags)
        assert len({(color, hatch) for _, color, hatch in classes.values()}) == len(flags)


def study(frequencies, restitutions):
    """Return a study. In three of twelve cells of each panel one start does not settle."""
    shape = 3, 4, len(frequencies), len(restitutions)
    counts = np.zeros((*shape, len(OUTCOMES)), int)
    counts[..., OUTCOMES.index("settled")] = 5
    counts[0, 1:] -= np.eye(len(OUTCOMES), dtype=int)[OUTCOMES.index("settled")]
    counts[0, 1:, ..., OUTCOMES.index("chaotic")] = 1
    data = {
        "largest_displacement": (AXES, np.linspace(0.1, 1, np.prod(shape)).reshape(shape)),
        "outcome_count": ((*AXES, "counted_outcome"), counts),
        "best_clearance": np.ones((3, *shape[2:])),
        "rule_clearance": (("mass_ratio", "frequency"), np.ones((3, shape[2]))),
    }
    coordinates = {
        "mass_ratio": [0.1, 0.2, 0.3],
        "clearance": [0.5, 1.0, 1.5, 2.0],
        "frequency": frequencies,
        "restitution": restitutions,
        "counted_outcome": list(OUTCOMES),
    }
    return dataset(data, coordinates, {"starts": 5}, "made up")


@pytest.mark.parametrize(("restitutions", "panels"), [([1.0], 2), ([0.8, 1.0], 4)])
def test_panels_and_hatched_cells(restitutions, panels):
    with style.context():
        drawn = draw_studies(studies=[study([1.5, 2.0], restitutions)])
        FigureCanvasAgg(drawn).draw()
    maps = [axes for axes in drawn.axes if axes.get_label() != "<colorbar>"]
    assert len(maps) == panels
    for axes in maps:
        (hatched,) = [patch for patch in axes.patches if type(patch) is PathPatch]
        # All hatched cells are one path, with five points for each rectangle.
        assert len(hatched.get_path().vertices) == 3 * 5
