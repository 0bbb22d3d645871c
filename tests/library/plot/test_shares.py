"""Shares of starts are stacked by motion, with their intervals."""

import numpy as np
import xarray as xr
from helpers.made_up import matched_sweep

from impact_damper.plot.panels.shares import draw_shares


def test_shares_are_stacked_with_intervals():
    axes = draw_shares(response=[matched_sweep()]).axes[0]
    quiet, chaos = axes.patches
    np.testing.assert_allclose(quiet.get_data().values, [0.5, 0.9, 0])
    np.testing.assert_allclose(quiet.get_data().edges, [0.75, 1.25, 1.75, 2.25])
    np.testing.assert_allclose(chaos.get_data().baseline, [0.5, 0.9, 0])
    np.testing.assert_allclose(chaos.get_data().values, 1)
    # The uppermost area, which ends at 1, has no interval.
    ends = [segment for lines in axes.collections for segment in lines.get_segments()]
    np.testing.assert_allclose(ends, [[[1, 0.25], [1, 0.75]], [[1.5, 0.45], [1.5, 0.95]]])
    assert "at most 30 %" in axes.get_title(loc="right")


def test_chaos_of_which_a_run_ended_is_a_transient():
    data = matched_sweep()
    ends = xr.zeros_like(data["outcome"]).assign_attrs({})
    ends[2, 0] = 3
    axes = draw_shares(response=[data.assign(life_ends=ends)]).axes[0]
    assert [each.get_label() for each in axes.patches] == [
        "period 1",
        "chaotic transient",
        "chaotic",
    ]
    np.testing.assert_allclose(axes.patches[1].get_data().values, [0.5, 0.9, 1])
    np.testing.assert_allclose(axes.patches[2].get_data().baseline, [0.5, 0.9, 1])


def test_a_motion_keeps_its_colour():
    """In a panel each area is one motion over all values; the legend names each kind once."""
    drawn = draw_shares(response=[matched_sweep(), matched_sweep()])
    assert [len(axes.patches) for axes in drawn.axes] == [2, 2]
    (legend,) = drawn.legends
    assert [text.get_text() for text in legend.get_texts()] == ["period 1", "chaotic"]
