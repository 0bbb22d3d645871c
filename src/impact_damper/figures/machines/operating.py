"""Maps of quiet share and displacement: over frequency and force, and over gap and restitution."""

import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import NullLocator

from impact_damper.data.datasets import parameters_of
from impact_damper.figures.machines.looks import STAR, finite
from impact_damper.figures.maps import COLOURS, edges
from impact_damper.figures.style import BLACK, GREY, PALE, WHITE, figure, style

CAPTION = """
Above: share of random starts that end quiet. Below: largest displacement of any of their motions;
hatched where one escapes. There are 12 starts in a cell, too few for a claim: the maps show where
the damper works, and the shares that count are those over the gap.
"""
FORCES = CAPTION + "Dashed: the nominal excitation, with which the limit of a quiet motion grows."
DAMPERS = CAPTION + "Star: the gap and the restitution of the design."
NOMINAL = STAR | {"markeredgecolor": WHITE, "markersize": 9}
LINE = {"color": BLACK, "linewidth": 1.0, "linestyle": (0, (4, 3))}


@style()
def draw_forces(data):
    """Return the maps over forcing frequency and excitation."""
    frequency, force = data["operating_frequency"].values, data["force_share"].values
    ends = _edges(frequency), edges(force)
    drawn, panels = _maps(*ends, data["force_map_share"].T, data["force_map_displacement"].T)
    for axes in panels:
        axes.axhline(1.0, **LINE)
        axes.set(yscale="log", ylabel="Excitation / nominal", yticks=force[::2])
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_locator(NullLocator())
    panels[-1].set_xlabel("Forcing frequency (Hz)")
    return drawn


@style()
def draw_dampers(data):
    """Return the maps over gap and restitution, at the frequency of the cliff."""
    gap, restitution = data["map_gap"].values, data["map_restitution"].values
    ends = edges(gap), _edges(restitution)
    drawn, panels = _maps(*ends, data["damper_map_share"].T, data["damper_map_displacement"].T)
    for axes in panels:
        axes.plot(float(data["design_gap"]), parameters_of(data)["restitution"], **NOMINAL)
        axes.set(xscale="log", ylabel="Restitution", xticks=gap[::2])
        axes.xaxis.set_major_formatter("{x:.3g}")
        axes.xaxis.set_minor_locator(NullLocator())
    panels[-1].set_xlabel(f"Gap, full play (mm), at {float(data['branch_frequency']):.4g} Hz")
    return drawn


def _maps(x, y, share, size):
    """Return a figure with a map of shares above a map of displacements, and its two axes."""
    drawn = figure("single", 4.8)
    panels = drawn.subplots(2, sharex=True)
    sizes = finite(size)
    norms = Normalize(0, 1), LogNorm(np.nanmin(sizes), np.nanmax(sizes))
    words = "Share of quiet starts", "Largest displacement (mm)"
    for axes, values, norm, label in zip(panels, (share, sizes), norms, words, strict=True):
        axes.set_facecolor(PALE)
        axes.patch.set(hatch="////", edgecolor=GREY, linewidth=0)
        shown = axes.pcolormesh(x, y, values, norm=norm, cmap=COLOURS, rasterized=True)
        bar = drawn.colorbar(shown, ax=axes, label=label)
        bar.ax.yaxis.set_major_formatter("{x:g}")
    return drawn, panels


def _edges(centres):
    """Return cell edges from evenly spaced centres."""
    half = (centres[1] - centres[0]) / 2
    return np.append(centres - half, centres[-1] + half)

