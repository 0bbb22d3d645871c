"""Policies of migration compared (figure kind `release_policies`).

Migration takes the oscillator from its resonance to its small motion: the damper is switched on,
and off again (the release) at a moment that a policy chooses. A trial begins with the resonance
motion, and the damper is switched on at a random phase.
"""

import numpy as np

from chatterjee1995.tables.policies import POLICIES
from impact_damper.plot.panels.style import (
    CURVES,
    axis_label,
    curve,
    figure,
    letter_panels,
    parameter_label,
    style,
)

CAPTION = """
Above: share of trials that reach the non-resonance motion within 350 cycles. Below: median cycles.
Parameters were chosen in separate trials. Settled: within 1e-4 of a periodic orbit. Bars: 95 %
intervals.
"""


@style({"axes.titley": None})
def draw_release_policies(*, release_policies):
    """Draw success and cycles of each policy, for each damper.

    Parameters
    ----------
    release_policies : list of xarray.Dataset
        One dataset of the stage release_policies.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = release_policies
    drawn = figure("double", 5.2)
    panels = drawn.subplots(2, data.sizes["case"], sharex=True, sharey="row", squeeze=False)
    for case, (above, below) in enumerate(panels.T):
        one = data.isel(case=case)
        above.set_title(case_label(one), fontsize=7.5, loc="right")
        draw_case(above, below, one)
    panels[0, 0].set_ylabel("Share within 350 cycles")
    panels[1, 0].set_ylabel("Median of the cycles")
    letter_panels(panels.ravel())
    handles, labels = panels[0, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=3)
    return drawn


def case_label(one):
    """Return symbols and values of the damper of a case."""
    names = "mass_ratio", "clearance", "restitution"
    return parameter_label({name: float(one[f"case_{name}"]) for name in names}, *names)


def draw_case(above, below, one):
    """Draw the policies with one damper: success above, cycles below."""
    frequency = one["frequency"].values
    for k, policy in enumerate(one["policy"].values):
        look = curve(k) | {"marker": CURVES[k][2], "label": POLICIES[policy]}
        success = one["policy_success"].sel(policy=policy).values
        spread = np.abs(success[:, 1:] - success[:, :1]).T
        # side by side, so that intervals do not hide each other
        above.errorbar(frequency + 0.004 * (k - 1.5), success[:, 0], spread, capsize=1.5, **look)
        cycles = one["policy_cycles"].sel(policy=policy, quantile=0.5).values
        draw_bounded(below, frequency + 0.004 * (k - 1.5), cycles, look)
    ends = frequency[0] - 0.03, frequency[-1] + 0.03
    above.set(xlim=ends, ylim=(-0.05, 1.05))
    below.set(yscale="log", ylim=(8, 400), xlabel=axis_label(one["frequency"]))


def draw_bounded(axes, places, values, look):
    """Draw values with their intervals.

    `values` has the shape (n, 3): value, lower and upper end. An infinite upper end is drawn as a
    bar that leaves the panel.
    """
    values = values[:, 0], values[:, 1], np.minimum(values[:, 2], 1e6)
    middle = np.where(np.isfinite(values[0]), values[0], np.nan)
    spread = middle - values[1], values[2] - middle
    axes.errorbar(places, middle, spread, capsize=1.5, **look)
