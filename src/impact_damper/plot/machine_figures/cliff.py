"""Share of quiet starts and displacement against the gap, with the cliff and the gap to build.

A start is a random initial state; it is quiet if it leads to a quiet motion, one below the
displacement limit of the design. The cliff is a gap at which the share of quiet starts falls below
the required share.
"""

import numpy as np

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.plot.machine_figures.looks import (
    CHOSEN,
    CLIFF,
    STAR,
    TOLERATED,
    decades,
    limit_line,
    plot_sizes,
)
from impact_damper.plot.style import BLUE, GREY, figure, legend, style

CAPTION = """
Horizontal: gap, the full play. Above: share of random starts that lead to quiet motions, at the
worst frequency of the band. Circles: coarse comparison, from few starts. Squares: candidates, from
all starts, with 95 % intervals. Below: largest displacement of all motions found over the band.
Star: smallest stable quiet orbit; few starts may lead to it. The star holds for one frequency:
among the frequencies with a stable quiet orbit, the one at which the machine without the damper
moves most. Blue line: exact quiet orbit at the frequency at which the share falls first. If the two
frequencies differ, the star is off the line.
"""
COARSE = {
    "color": GREY,
    "marker": "o",
    "markersize": 3.0,
    "linestyle": "-",
    "linewidth": 0.6,
    "markerfacecolor": "none",
    "label": "coarse comparison",
}
CANDIDATES = {
    "color": BLUE,
    "marker": "s",
    "markersize": 3.2,
    "linestyle": "-",
    "linewidth": 0.8,
    "label": "candidates",
}
ORBIT = {"color": BLUE, "linewidth": 1.0, "label": "quiet orbit, stable"}
UNSTABLE = {
    "color": BLUE,
    "linewidth": 0.8,
    "linestyle": (0, (1, 1.5)),
    "label": "quiet orbit, unstable",
}
ASKED = {"color": GREY, "linewidth": 0.8, "linestyle": (0, (1, 1.2)), "label": "share required"}
BEST = STAR | {"label": "smallest stable quiet orbit"}


@style()
def draw_cliff(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    drawn = figure("single", 4.6)
    upper, lower = drawn.subplots(2, sharex=True, height_ratios=(2, 3))
    share_panel(upper, data)
    size_panel(lower, data)
    lower.set_xlabel("Gap, full play (mm)")
    legend(drawn, 2)
    return drawn


def share_panel(axes, data):
    """Draw the least share of quiet starts over the band against the gap."""
    _mark_gap(axes, data)
    axes.plot(data["coarse_gap"], data["coarse_share"], **COARSE)
    shares = data["start_quiet_share"].values
    rows, least = np.arange(len(shares)), shares.argmin(axis=1)
    share, ends = shares[rows, least], data["start_quiet_interval"].values[rows, least]
    bars = np.clip(np.abs(ends.T - share), 0, None)
    axes.errorbar(data["candidate_gap"], share, bars, elinewidth=0.8, capsize=1.5, **CANDIDATES)
    axes.axhline(parameters_of(data)["share"], **ASKED)
    axes.set(ylim=(-0.02, 1.04), ylabel="Share of quiet starts")


def size_panel(axes, data):
    """Draw the largest displacement over the band, and the quiet orbit, against the gap."""
    _mark_gap(axes, data)
    plot_sizes(axes, data["coarse_gap"].values, data["coarse_displacement"].values, **COARSE)
    worst = data["worst_displacement"].values.max(axis=1)
    plot_sizes(axes, data["candidate_gap"].values, worst, **CANDIDATES)
    for gap, size, stable in stable_runs(data, "gap"):
        axes.plot(gap, size, **(ORBIT if stable else UNSTABLE))
    if int(data["best_orbit_status"]) != flag("best_orbit_status", "absent"):
        axes.plot(data["best_orbit_gap"], data["best_orbit_displacement"], **BEST)
    limit_line(axes, data)
    axes.set(xlim=_span(data), ylabel="Largest displacement (mm)")
    decades(axes)


def _span(data):
    """Return the limits of the axis of gaps, mm: around candidates, best orbit and edges."""
    names = ("candidate_gap", "best_orbit_gap", "cliff_gap", "cliff_beyond", "stability_gap")
    gaps = np.concatenate([np.ravel(data[name].values) for name in names])
    coarse = data["coarse_gap"].values
    low, high = 0.85 * np.nanmin(gaps), 1.15 * np.nanmax(gaps)
    return max(low, 0.97 * coarse[0]), min(high, 1.03 * coarse[-1])


def stable_runs(data, parameter):
    """Yield the parts of a branch of quiet orbits on which all orbits are stable, or all unstable.

    Parameters
    ----------
    data : xarray.Dataset
    parameter : str
        "gap" or "force".

    Yields
    ------
    (array, array, bool)
        Gap (mm) or multiple of the force, largest displacement (mm), and whether stable.
    """
    names = (f"{parameter}_of_orbit", f"displacement_by_{parameter}", f"modulus_by_{parameter}")
    value, size, modulus = (data[name].values for name in names)
    stable = modulus < 1
    edges = [0, *(np.flatnonzero(np.diff(stable)) + 1), len(value)]
    for first, last in zip(edges, edges[1:], strict=False):
        if last > first:
            # includes the first orbit of the next part, so that the lines of both parts join
            part = slice(first, last + 1)
            yield value[part], size[part], bool(stable[first])


def _mark_gap(axes, data):
    """Mark the chosen gap, its tolerance, and the cliffs."""
    gap = float(data["design_gap"])
    tolerance = parameters_of(data)["tolerances"].get("gap", 0.0)
    axes.axvspan(gap * (1 - tolerance), gap * (1 + tolerance), **TOLERATED)
    axes.axvline(gap, **CHOSEN)
    found = data["cliff_status"].values == flag("cliff_status", "found")
    for edge in data["cliff_gap"].values[found]:
        axes.axvline(edge, **CLIFF)
