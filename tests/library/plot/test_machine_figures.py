"""Figures of a machine have the right contents, and draw every case without a warning."""

import numpy as np
import pytest
from helpers.made_up_design import made_up_design
from matplotlib.backends.backend_agg import FigureCanvasAgg

from impact_damper.plot.branches import parts_by_stability
from impact_damper.plot.machine_figures import (
    FIGURES,
    draw_machines,
    over_frequency,
)

pytestmark = pytest.mark.filterwarnings("error")

CASES = {
    "build": {"displacement_limit": 1.5},
    "escapes": {
        "promised_displacement": np.inf,
        "promise_displacement": np.full((3, 5), np.inf),
        "searched_displacement": [1e9, 1, 1, 1, 1],
        "force_map_displacement": np.tile([0.2, 0.4, 0.8, 6.0, np.inf], (5, 1)),
    },
    "without_orbit_or_absorber": {
        "modulus_by_gap": np.full(4, 2.0),
        "best_orbit_gap": np.nan,
        "best_orbit_displacement": np.nan,
        "tuned_displacement": np.nan,
    },
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_is_drawn_within_its_sheet(name, case):
    drawn = FIGURES[name](made_up_design(**CASES[case]))
    FigureCanvasAgg(drawn).draw()
    for axes in drawn.axes:
        box = axes.get_tightbbox()
        assert box.x0 > -1 and box.y0 > -1
        assert box.x1 < drawn.bbox.width + 1 and box.y1 < drawn.bbox.height + 1


def test_the_overview_has_a_row_for_each_machine():
    drawn = draw_machines(machines=[made_up_design(), made_up_design("do_not_build")])
    FigureCanvasAgg(drawn).draw()
    assert [axes.get_title("left") for axes in drawn.axes[::2]] == [
        "(a) made up, 12 kg",
        "(b) made up, 12 kg",
    ]


def test_values_that_were_not_run_at_a_frequency_are_interpolated():
    table = np.array([[1, 2, 3, 2, 1], [5, np.nan, 5, np.nan, 1], [0, 0, 0, 0, 0]], float)
    nominal, worst = over_frequency(made_up_design(promise_displacement=table))
    assert list(nominal) == [1, 2, 3, 2, 1]
    assert list(worst) == [5, 5, 5, 3, 1]


def test_the_quiet_orbit_is_cut_where_its_stability_changes():
    data = made_up_design()
    gaps, modulus = data["gap_of_orbit"].values, data["modulus_by_gap"].values
    parts = list(parts_by_stability(gaps, gaps, modulus < 1))
    assert [stable for *_, stable in parts] == [False, True, False]
    assert [list(gap) for gap, *_ in parts] == [[6, 7], [7, 8, 9], [9]]
