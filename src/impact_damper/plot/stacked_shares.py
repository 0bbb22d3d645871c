"""Shares of random starts that lead to each motion, over frequency or clearance."""

from collections import Counter

import numpy as np
from matplotlib.colors import to_rgb

from impact_damper.data.sweeps import families
from impact_damper.plot import style
from impact_damper.plot.maps import edges_of
from impact_damper.plot.sheets import dataset_in, sheet

# Kind of motion -> colour, hatching. Kinds are stacked in this order, the first at the bottom.
LOOKS = {
    "period 1": (style.BLUE, ""),
    "period 2": (style.GREEN, "////"),
    "period 3": (style.PURPLE, "\\\\\\\\"),
    "other periods": (style.VERMILION, "xxxx"),
    "quasi-periodic": (style.SKY, "||||"),
    "no contact": (style.GREY, ""),
    "chaotic transient": (style.ORANGE, "++++"),
    "chaotic": (style.ORANGE, "...."),
    "others": (style.BLACK, ""),
}
OUTCOMES = {
    "quasi_periodic": "quasi-periodic",
    "non_colliding": "no contact",
    "drifting": "no contact",
    "chaotic": "chaotic",
}
# Fraction of white in the colour of a motion: the most frequent of its kind, the second, others.
PALER = (0.0, 0.45, 0.7)
EDGE = {"fill": True, "edgecolor": style.WHITE, "linewidth": 0.4}
INTERVAL = {"color": style.BLACK, "linewidth": 0.6}


def shares(data, axes=None):
    """Draw the stacked shares of random starts that lead to each motion, with 95 % intervals.

    The colour shows the kind of a motion, such as "period 1". Among motions of the same kind, the
    motion with most starts has the full colour, and the others are paler.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `frequency_response`, `subharmonic_suppression` or `clearance_sweep`.
    axes : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import impact_damper as idm
    >>> bare = idm.frequency_response(idm.Oscillator(0.215), None, [1.9, 2.0], starts=8)
    >>> axes = idm.plot.shares(bare)
    """
    words = "frequency_response, subharmonic_suppression or clearance_sweep"
    found = dataset_in(data, lambda each: "run_outcome" in each, words)
    dimension = found["run_outcome"].dims[0]
    places, starts = found[dimension].values, found.sizes["start"]
    edges = edges_of(places) if len(places) > 1 else places * np.array([0.95, 1.05])
    below = np.zeros(len(places))
    with sheet(axes, columns=4) as (axes,):
        for kind, rank, chosen in _ranked_motions(found):
            share = np.where(chosen, found["motion_starts"].values, 0).sum(axis=1) / starts
            label = style.once(axes, kind)
            axes.stairs(below + share, edges, baseline=below, label=label, **_look(kind, rank))
            row, column = np.nonzero(chosen & (below + share < 1)[:, None])
            low, high = (found[f"share_{end}"].values[row, column] for end in ("lower", "upper"))
            axes.vlines(places[row], below[row] + low, below[row] + high, **INTERVAL)
            below = below + share
        axes.set(xlabel=style.axis_label(found[dimension]), ylabel="Share of random starts")
        axes.set(xlim=edges[[0, -1]], ylim=(0, 1))
    return axes


def _look(kind, rank):
    colour, hatch = LOOKS[kind]
    if rank and kind == "period 1":
        hatch = "----"  # pale blue without hatching resembles another kind
    white = PALER[min(rank, len(PALER) - 1)]
    face = [white + (1 - white) * part for part in to_rgb(colour)]
    return EDGE | {"facecolor": face, "hatch": hatch}


def _ranked_motions(data):
    """Return (kind, rank, mask) of each motion. Rank 0 is the most frequent motion of its kind."""
    found, ranks = {kind: [] for kind in LOOKS}, Counter()
    for each in families(data):
        if each.starts:
            kind = OUTCOMES.get(each.outcome, "others")
            if each.outcome == "settled":
                kind = f"period {each.period}" if each.period < 4 else "other periods"
            for name, places in _parts(data, kind, each.places).items():
                if data["motion_starts"].values[places].any():
                    found[name].append((ranks[kind], places))
            ranks[kind] += 1
    return [(kind, *ranked) for kind, motions in found.items() for ranked in motions]


def _parts(data, kind, places):
    if kind != "chaotic" or "life_ends" not in data:
        return {kind: places}
    ended = data["life_ends"].values > 0
    return {"chaotic transient": places & ended, kind: places & ~ended}
