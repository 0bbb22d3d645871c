"""Shares of random starts that lead to each motion (figure kinds `shares`, `clearance_shares`).

A start is an initial state. The motions are listed for each value of a parameter, the frequency or
the clearance. Chaos is called transient if it ended in one of several longer runs.
"""

from collections import Counter

import numpy as np
from matplotlib.colors import to_rgb

from impact_damper.data.datasets import parameters_of
from impact_damper.data.sweeps import families
from impact_damper.plot.panels.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    WHITE,
    axis_label,
    figure,
    legend,
    letter_panels,
    parameter_label,
    style,
)

CAPTION = """
Share of random starts that lead to each motion. A motion keeps its colour from value to value;
further motions of a kind are paler, of period 1 also hatched. Chaos is called transient where at
least one longer run of it ended. Bars: 95 % intervals (Wilson). Titles: bound on the share of a
motion not found.
"""

# Kinds of motions from below: label, colour and hatching.
LOOKS = {
    "period 1": (BLUE, ""),
    "period 2": (GREEN, "////"),
    "period 3": (PURPLE, "\\\\\\\\"),
    "other periods": (VERMILION, "xxxx"),
    "quasi-periodic": (SKY, "||||"),
    "no contact": (GREY, ""),
    "chaotic transient": (ORANGE, "++++"),
    "chaotic": (ORANGE, "...."),
    "others": (BLACK, ""),
}
# Kinds of settled motions by period, and of others by outcome.
PERIODS = {1: "period 1", 2: "period 2", 3: "period 3"}
OUTCOMES = {
    "quasi_periodic": "quasi-periodic",
    "non_colliding": "no contact",
    "drifting": "no contact",
    "chaotic": "chaotic",
}
# Hatching of further motions of kinds without hatching. Pale blue alone resembles another kind.
FURTHER = {"period 1": "----"}
# Fractions of white mixed into the colours of the first, second, third ... motion of a kind.
PALER = (0.0, 0.45, 0.7)
EDGE = {"edgecolor": WHITE, "linewidth": 0.4}
INTERVAL = {"color": BLACK, "linewidth": 0.6}
# Half width of the column of a dataset with a single parameter value, as a fraction of this value.
HALF_WIDTH = 0.05


@style()
def draw_shares(*, response):
    """Draw shares over frequency.

    Parameters
    ----------
    response : list of xarray.Dataset
        Datasets of the stage response with a damper.

    Returns
    -------
    matplotlib.figure.Figure
    """
    return _draw(response, ("mass_ratio", "clearance", "restitution"))


@style()
def draw_clearance_shares(*, optimum):
    """Draw shares over the clearance.

    Parameters
    ----------
    optimum : list of xarray.Dataset
        Datasets of the stage optimum.

    Returns
    -------
    matplotlib.figure.Figure
    """
    return _draw(optimum, ("mass_ratio", "restitution", "frequency"))


def _draw(datasets, named):
    """Return a figure with one panel for each dataset; titles hold the parameters `named`."""
    columns = min(len(datasets), 2)
    rows = -(-len(datasets) // columns)
    empty = rows * columns > len(datasets)
    drawn = figure("double", (0.2 if empty else 0.8) + 2.3 * rows)
    panels = drawn.subplots(rows, columns, squeeze=False, sharey=True)
    used = panels.flat[: len(datasets)]
    for axes, data in zip(used, datasets, strict=True):
        shares_panel(axes, data)
        unseen = f"not seen: at most {100 * float(data['missed_share']):.2g} %"
        words = parameter_label(parameters_of(data), *named)
        axes.set_title(f"{words}; {unseen}", loc="right", fontsize=8)
    for axes in panels[:, 0]:
        axes.set_ylabel("Share of random starts")
    if len(datasets) > 1:
        letter_panels(used)
    if empty:
        legend(drawn, 2, order=LOOKS, place=panels.flat[-1])
    else:
        legend(drawn, 4, order=LOOKS)
    return drawn


def shares_panel(axes, data):
    """Stack the shares of random starts that lead to each motion, over the parameter of a sweep.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    data : xarray.Dataset
        Of a sweep of frequency or clearance.
    """
    dimension = data["run_outcome"].dims[0]
    places, starts = data[dimension].values, data.sizes["start"]
    edges = _edges(places)
    below = np.zeros(len(places))
    for kind, rank, chosen in ranked_motions(data):
        share = np.where(chosen, data["motion_starts"].values, 0).sum(axis=1) / starts
        colour, hatch = LOOKS[kind]
        hatch = FURTHER.get(kind, hatch) if rank else hatch
        white = PALER[min(rank, len(PALER) - 1)]
        face = [white + (1 - white) * part for part in to_rgb(colour)]
        look = {"fill": True, "facecolor": face, "hatch": hatch, **EDGE}
        axes.stairs(below + share, edges, baseline=below, label=kind, **look)
        row, column = np.nonzero(chosen & (below + share < 1)[:, None])
        ends = [
            below[row] + data[name].values[row, column] for name in ("share_lower", "share_upper")
        ]
        axes.vlines(places[row], *ends, **INTERVAL)
        below = below + share
    axes.set(xlabel=axis_label(data[dimension]), xlim=edges[[0, -1]], ylim=(0, 1))


def _edges(places):
    """Return the edges of columns around increasing values, halfway between, shape (n + 1,)."""
    if len(places) == 1:
        return places[0] * np.array([1 - HALF_WIDTH, 1 + HALF_WIDTH])
    middle = (places[1:] + places[:-1]) / 2
    return np.concatenate([[2 * places[0] - middle[0]], middle, [2 * places[-1] - middle[-1]]])


def ranked_motions(data):
    """Return the motions that random starts lead to, in the order of their kinds in `LOOKS`.

    Parameters
    ----------
    data : xarray.Dataset
        Of a sweep.

    Returns
    -------
    list of (str, int, array of bool)
        For each motion its kind; its rank among the motions of its kind, 0 for the motion with most
        starts; and a mask of its entries in the variables of the sweep, shape (value, motion). A
        chaotic motion that is a transient at some values is listed twice, with the same rank.
    """
    found, ranks = {kind: [] for kind in LOOKS}, Counter()
    for each in families(data):
        if each.starts:
            kind = _kind(each)
            for name, places in _parts(data, kind, each.places).items():
                if data["motion_starts"].values[places].any():
                    found[name].append((ranks[kind], places))
            ranks[kind] += 1
    return [(kind, *ranked) for kind, motions in found.items() for ranked in motions]


def _parts(data, kind, places):
    """Return the mask of a motion by kind; chaos is a transient where one of its runs ended."""
    if kind != "chaotic" or "life_ends" not in data:
        return {kind: places}
    ended = data["life_ends"].values > 0
    return {"chaotic transient": places & ended, kind: places & ~ended}


def _kind(motion):
    """Return the key in `LOOKS` of a motion."""
    if motion.outcome == "settled":
        return PERIODS.get(motion.period, "other periods")
    return OUTCOMES.get(motion.outcome, "others")
