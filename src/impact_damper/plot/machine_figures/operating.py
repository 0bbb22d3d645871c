"""Maps of the share of quiet starts and of displacement, over two pairs of parameters.

The pairs are frequency and force, and gap and restitution. A start is a random initial state; it is
quiet if it leads to a motion below the quiet limit, the displacement limit of the design.
"""

import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.patheffects import withStroke
from matplotlib.ticker import NullLocator

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.machine_figures.looks import STAR, finite, name_numbers
from impact_damper.plot.style import (
    BLACK,
    GREY,
    PALE,
    VERMILION,
    WHITE,
    figure,
    legend,
    style,
)

CAPTION = """
Above: share of random starts that lead to quiet motions. Below: largest displacement of any motion;
hatched: a motion escapes. Light is good. Each cell has only 12 starts, so that a share in the map
is a rough estimate. Line: the exact quiet orbit loses its stability or ends, interpolated between
the middles of cells.
"""
FORCES = CAPTION + (
    "Red: the nominal excitation. The quiet limit is proportional to the excitation: at half the "
    "excitation a motion counts as quiet up to half the limit. A dark cell below the red line may "
    "therefore hold motions smaller than the limit of the design."
)
DAMPERS = CAPTION + "Star: the gap and the restitution of the design."
NOMINAL = STAR | {"markeredgecolor": WHITE, "markersize": 9}
LINE = {"color": VERMILION, "linewidth": 1.3, "label": "nominal excitation"}
HALO = [withStroke(linewidth=2.6, foreground=WHITE)]
# Modulus in cells without an orbit, so that the line at 1 passes between them and the others.
ABSENT = 2.0


@style()
def draw_forces(data):
    """Return the maps over forcing frequency and excitation."""
    frequency, force = data["operating_frequency"].values, data["force_share"].values
    ends = _edges(frequency), np.exp(_edges(np.log(force)))
    drawn, panels = _maps(*ends, data["force_map_share"].T, data["force_map_displacement"].T)
    for axes in panels:
        axes.axhline(1.0, path_effects=HALO, **LINE)
        _draw_stability(axes, frequency, force, data["force_map_modulus"].T)
        axes.set(yscale="log", ylabel="Excitation / nominal", yticks=force[::2])
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_locator(NullLocator())
        axes.set(xlim=ends[0][[0, -1]], ylim=ends[1][[0, -1]])
    panels[-1].set_xlabel("Forcing frequency (Hz)")
    legend(drawn, 2)
    return drawn


@style()
def draw_dampers(data):
    """Return the maps over gap and restitution, at the frequency at which quiet gaps end first."""
    gap, restitution = data["map_gap"].values, data["map_restitution"].values
    ends = np.exp(_edges(np.log(gap))), _edges(restitution)
    drawn, panels = _maps(*ends, data["damper_map_share"].T, data["damper_map_displacement"].T)
    star = NOMINAL | {"label": "this design"}
    for axes in panels:
        axes.plot(float(data["design_gap"]), parameters_of(data)["restitution"], **star)
        _draw_stability(axes, gap, restitution, data["damper_map_modulus"].T)
        axes.set(xscale="log", ylabel="Restitution", xticks=gap[::2])
        axes.xaxis.set_major_formatter("{x:.3g}")
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set(xlim=ends[0][[0, -1]], ylim=ends[1][[0, -1]])
    panels[-1].set_xlabel(f"Gap, full play (mm), at {float(data['branch_frequency']):.4g} Hz")
    legend(drawn, 2)
    return drawn


def _maps(x, y, share, size):
    """Return a figure with a map of shares above a map of displacements, and its two axes."""
    drawn = figure("single", 5.2)
    panels = drawn.subplots(2, sharex=True)
    sizes = finite(size)
    low, high = np.nanmin(sizes), np.nanmax(sizes)
    looks = (
        (share, "cividis", Normalize(0, 1), "Share of quiet starts"),
        (sizes, "cividis_r", LogNorm(low, high), "Largest displacement (mm)"),
    )
    for axes, (values, colours, norm, label) in zip(panels, looks, strict=True):
        axes.set_facecolor(PALE)
        axes.patch.set(hatch="////", edgecolor=GREY, linewidth=0)
        shown = axes.pcolormesh(x, y, values, norm=norm, cmap=colours, rasterized=True)
        bar = drawn.colorbar(shown, ax=axes, label=label)
    name_numbers(bar.ax.yaxis, low, high)
    return drawn, panels


def _edges(centres):
    """Return cell edges midway between the centres, shape (len(centres) + 1,)."""
    middles = (centres[1:] + centres[:-1]) / 2
    ends = 2 * centres[[0, -1]] - middles[[0, -1]]
    return np.concatenate([ends[:1], middles, ends[1:]])


def _draw_stability(axes, x, y, modulus):
    """Draw the line on which the quiet orbit loses its stability."""
    known = np.where(np.isnan(modulus), ABSENT, modulus)
    if known.min() < 1 < known.max():
        line = axes.contour(x, y, known, [1.0], colors=BLACK, linewidths=1.1)
        line.set(path_effects=HALO)
        axes.plot([], [], color=BLACK, linewidth=1.1, label="end of stability")
