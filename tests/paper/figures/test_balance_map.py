"""The drawing of a balance map: every class of cells is drawn and named in a legend.

A class is a verdict on harmonic balance, such as "called stable, orbit is unstable".
"""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from chatterjee1995.figures.balance_map import QUIET, VIOLENT, draw_balance_map
from chatterjee1995.variables.balance_map import HIGH_VERDICT, QUIET_VERDICT
from impact_damper.data.datasets import dataset
from impact_damper.plot.style import style

pytestmark = pytest.mark.filterwarnings("error")

COLUMNS = 12


def made_up():
    """Return a map over the restitution in which each class fills at least two columns."""
    shape = 3, COLUMNS

    def cells(values):
        return np.broadcast_to(np.resize(list(values), COLUMNS), shape)

    data = {
        "quiet_verdict": cells(QUIET_VERDICT.values()),
        "high_verdict": cells(HIGH_VERDICT.values()),
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
    with style():
        drawn = draw_balance_map(balance_map=[made_up()])
        FigureCanvasAgg(drawn).draw()
        yield drawn


def test_every_class_is_named(drawing):
    for legend, classes in zip(drawing.legends, (QUIET, VIOLENT), strict=True):
        words = [text.get_text() for text in legend.get_texts() if text.get_text()]
        assert {label for label, _, _ in classes.values()} <= set(words)
        assert len(set(words)) == len(words)


def test_classes_have_names_for_all_flags_and_looks_of_their_own():
    for classes, flags in ((QUIET, QUIET_VERDICT), (VIOLENT, HIGH_VERDICT)):
        assert set(classes) == set(flags)
        assert len({(color, hatch) for _, color, hatch in classes.values()}) == len(flags)


def test_legends_lie_on_the_sheet_and_beside_the_panels(drawing):
    box = drawing.get_tightbbox()
    assert min(box.x0, box.y0) >= 0
    assert box.x1 <= drawing.get_figwidth() and box.y1 <= drawing.get_figheight()
    left, right = (legend.get_window_extent() for legend in drawing.legends)
    assert not left.overlaps(right)
    for axes in drawing.axes:
        assert not left.overlaps(axes.get_tightbbox()) and not right.overlaps(axes.get_tightbbox())


def test_ends_of_the_map_are_not_ends_of_the_orbit(drawing):
    quiet, _ = drawing.axes
    shown = [line.get_xdata() for line in quiet.lines if np.size(line.get_xdata()) == 3]
    lower, upper, rigid = shown
    assert np.isfinite(lower).all() and np.isnan(upper).all()
    assert rigid[0] == 0.9
