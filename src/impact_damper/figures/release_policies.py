"""Policies of migration compared (figure kind `release_policies`)."""

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.figures.style import (
    CURVES,
    axis_label,
    curve,
    figure,
    letter_panels,
    parameter_label,
    style,
)

CAPTION = """
Above: share of trials that reach the non-resonance motion within 350 cycles, with 95 % intervals,
by four rules of release. Middle: median of the cycles. Below: effect of errors of the measured
state, relative to the resonance motion, and of delay, against the margin inside the basin.
"""

WORDS = {
    "settled": "random phase once settled",
    "hold": "fixed number of cycles",
    "phase": "fixed phase",
    "state": "state in the goal's basin",
}


@style({"axes.titley": None})
def draw_release_policies(*, release_policies):
    """Draw success and cycles of each policy, and the effect of noise and delay.

    Parameters
    ----------
    release_policies : list of xarray.Dataset
        One dataset of the stage release_policies.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = release_policies
    number = data.sizes["case"]
    drawn = figure("double", 7.0)
    grid = drawn.add_gridspec(3, 2 * number)
    panels = np.empty((2, number), object)
    for row, case in np.ndindex(panels.shape):
        panels[row, case] = drawn.add_subplot(grid[row, 2 * case : 2 * case + 2])
    for case, (above, below) in enumerate(panels.T):
        one = data.isel(case=case)
        made = {
            name: float(one[f"case_{name}"]) for name in ("mass_ratio", "clearance", "restitution")
        }
        above.set_title(parameter_label(made, *made), fontsize=7.5, loc="right")
        draw_case(above, below, one)
    panels[0, 0].set_ylabel("Share within 350 cycles")
    panels[1, 0].set_ylabel("Median of the cycles")
    noisy, late = drawn.add_subplot(grid[2, :number]), drawn.add_subplot(grid[2, number:])
    draw_disturbed(noisy, data["noisy_success"], "noise", "error of the state {:.1%}")
    draw_disturbed(late, data["delayed_success"], "delay", "{:g} of a period late")
    frequency = parameters_of(data)["noisy_frequency"]
    for axes in (noisy, late):
        axes.set_title(rf"$\Omega = {frequency:g}$", loc="right")
    noisy.set_ylabel("Share within 350 cycles")
    letter_panels([*panels[0], *panels[1], noisy, late])
    handles, labels = panels[0, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=4)
    return drawn


def draw_case(above, below, one):
    """Draw the policies with one damper: success above, cycles below."""
    frequency = one["frequency"].values
    for k, policy in enumerate(one["policy"].values):
        look = curve(k) | {"marker": CURVES[k][2], "label": WORDS[policy]}
        success = one["policy_success"].sel(policy=policy).values
        spread = np.abs(success[:, 1:] - success[:, :1]).T
        # side by side, so that intervals do not hide each other
        above.errorbar(frequency + 0.004 * (k - 1.5), success[:, 0], spread, capsize=1.5, **look)
        cycles = one["policy_cycles"].sel(policy=policy, quantile=0.5, bound="share").values
        below.plot(frequency, np.where(np.isfinite(cycles), cycles, np.nan), **look)
    ends = frequency[0] - 0.03, frequency[-1] + 0.03
    above.set(xlim=ends, ylim=(-0.05, 1.05))
    below.set(yscale="log", xlim=ends, ylim=(5, 400), xlabel=axis_label(one["frequency"]))


def draw_disturbed(axes, success, name, words):
    """Draw success against the margin for each value of a disturbance, five of them at most."""
    for k, value in enumerate(success[name].values[-len(CURVES) :]):
        look = curve(k) | {"marker": CURVES[k][2], "label": words.format(value)}
        axes.plot(success["margin"], success.sel({name: value, "bound": "share"}), **look)
    axes.set(ylim=(-0.05, 1.05), xlabel="Margin over the size of the resonance motion")
    axes.legend(loc="lower left")
