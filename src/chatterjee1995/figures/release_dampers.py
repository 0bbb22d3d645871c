"""Dampers compared for migration and for suppression (figure kind `release_dampers`).

Migration takes the oscillator from its resonance to its small motion, the goal: the damper is
switched on, and off again at a moment that a policy chooses. Suppression leaves the damper on; the
quiet motion with damper is then small.
"""

import numpy as np
from matplotlib.colors import LogNorm

from chatterjee1995.stages.best_dampers import best_clearances
from impact_damper.plot.panels.maps import mesh
from impact_damper.plot.panels.style import (
    CURVES,
    VERMILION,
    WHITE,
    axis_label,
    curve,
    figure,
    letter_panels,
    style,
)

CAPTION = """
(a) to (f): median cycles until the goal by two policies, and max |Z1| of the quiet motion over the
free resonance. Hatched: above 350 cycles, or no quiet motion. Circle: best gap for suppression;
cross: for migration by state. (g), (h): damper of figure 13 at other restitutions e.
"""
# Colour scales of the cycles and of the displacements.
CYCLES, DISPLACEMENTS = LogNorm(8, 350), LogNorm(0.02, 0.5)
# Labels and ticks of the colour bars.
SCALES = (
    ("Median of the cycles", [10, 30, 100, 300]),
    ("max $|Z_1|$ / resonance", [0.02, 0.05, 0.1, 0.2, 0.5]),
)
TITLES = "By state", "Random phase", "Quiet motion"


@style({"axes.titley": None})
def draw_release_dampers(*, release_dampers):
    """Draw maps over mass ratio and clearance, and a cut over the restitution.

    Parameters
    ----------
    release_dampers : list of xarray.Dataset
        One dataset of the stage release_dampers; its lowest frequency is drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
    data = release_dampers[0].isel(frequency=0)
    number = data.sizes["restitution"]
    drawn = figure("double", 1.9 * number + 3.2)
    grid = drawn.add_gridspec(number + 1, 6)
    maps = [
        [drawn.add_subplot(grid[r, 2 * c : 2 * c + 2]) for c in range(3)] for r in range(number)
    ]
    for row, panels in enumerate(maps):
        one = data.isel(restitution=row)
        drawn_maps = draw_maps(panels, one)
        for axes, title in zip(panels, TITLES, strict=True):
            axes.set_title(rf"{title}, $e = {float(one.restitution):g}$", loc="right", fontsize=8)
        panels[0].set_ylabel(axis_label(data["mass_ratio"]))
        for axes in panels[1:]:
            axes.set_yticklabels([])
    for axes in [axes for panels in maps[:-1] for axes in panels]:
        axes.set_xticklabels([])
    for axes in maps[-1]:
        axes.set_xlabel("Clearance, $d_0$")
    columns = [[row[0] for row in maps] + [row[1] for row in maps], [row[2] for row in maps]]
    for mapped, axes, (label, ticks) in zip(drawn_maps[1:], columns, SCALES, strict=True):
        bar = drawn.colorbar(
            mapped, ax=axes, label=label, location="bottom", aspect=30, ticks=ticks, format="%g"
        )
        bar.minorticks_off()
    left, right = drawn.add_subplot(grid[number, :3]), drawn.add_subplot(grid[number, 3:])
    draw_cut(left, right, data)
    letter_panels([*(axes for row in maps for axes in row), left, right])
    return drawn


def draw_maps(panels, one):
    """Draw the three maps for one restitution, and return the three coloured meshes."""
    x, y = one["clearance"].values, one["mass_ratio"].values
    cycles = one["damper_cycles"].sel(bound="share")
    cycles = cycles.where(np.isfinite(cycles))
    values = [cycles.sel(policy=name) for name in ("state", "settled")]
    values.append(one["damper_quiet"] / one["resonance_displacement"])
    norms = CYCLES, CYCLES, DISPLACEMENTS
    shown = [
        mesh(axes, x, y, each.transpose("mass_ratio", "clearance"), norm)
        for axes, each, norm in zip(panels, values, norms, strict=True)
    ]
    best = best_clearances(one)
    for axes in panels:
        axes.plot(best["suppression"], y, "o", color=WHITE, markeredgecolor="k", markersize=4)
        axes.plot(best["migration"], y, "x", color=VERMILION, markersize=5)
    return shown


def draw_cut(left, right, data):
    """Draw success of both policies, and displacements, against the restitution."""
    e = data["cut_restitution"]
    for k, (policy, words) in enumerate([("state", "by state"), ("settled", "at a random phase")]):
        success = data["cut_success"].sel(policy=policy)
        middle = success.sel(bound="share")
        spread = np.abs(success.sel(bound=["lower", "upper"]) - middle).transpose("bound", ...)
        look = curve(k) | {"marker": CURVES[k][2], "label": words}
        left.errorbar(e, middle, spread, capsize=1.5, **look)
    for k, (name, words) in enumerate([("quiet", "quiet motion"), ("largest", "largest motion")]):
        look = curve(k + 2) | {"marker": CURVES[k + 2][2], "label": words}
        right.plot(e, data[f"cut_{name}"] / data["resonance_displacement"], **look)
    left.set(ylim=(-0.05, 1.05), ylabel="Share within 350 cycles")
    right.set(ylim=(0, None), ylabel="max $|Z_1|$ / resonance")
    for axes in (left, right):
        axes.set_xlabel("Restitution, $e$")
        axes.legend(loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0, ncols=2)
