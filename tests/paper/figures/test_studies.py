"""A map of a study: a panel for each frequency and restitution, unsettled cells hatched."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import PathPatch

from chatterjee1995.figures.studies import draw_studies
from chatterjee1995.variables.studies import AXES, OUTCOMES
from impact_damper.data.datasets import dataset
from impact_damper.plot.style import style

pytestmark = pytest.mark.filterwarnings("error")


def made_up(frequencies, restitutions):
    """Return a study in which three of twelve cells of each panel have a start without settling."""
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


@pytest.mark.parametrize(
    ("frequencies", "restitutions", "panels"),
    [([2.0], [1.0], 1), ([1.5, 2.0], [1.0], 2), ([1.5, 2.0], [0.8, 1.0], 4)],
)
def test_panels_and_hatched_cells(frequencies, restitutions, panels):
    with style():
        drawn = draw_studies(studies=[made_up(frequencies, restitutions)])
        FigureCanvasAgg(drawn).draw()
    maps = [axes for axes in drawn.axes if axes.get_label() != "<colorbar>"]
    assert len(maps) == panels
    for axes in maps:
        (hatched,) = [patch for patch in axes.patches if type(patch) is PathPatch]
        # All hatched cells are one path, with five points for each rectangle.
        assert len(hatched.get_path().vertices) == 3 * 5
