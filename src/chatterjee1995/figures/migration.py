"""Figures 13 to 16 of the paper (migration), and figures of basins and release policies."""

import numpy as np

from chatterjee1995.reading.datasets import POLICIES
from impact_damper.data.datasets import decode, named, parameters_of
from impact_damper.plot import style
from impact_damper.plot.basin_plane import basins as basins_plot
from impact_damper.plot.motions import migration as migration_plot

AROUND = -15, 25  # first and last cycle of the detail panel, relative to the last release
DESTINATIONS = {
    "non_resonance": style.markers(
        "released to the non-resonance motion", style.BLUE, ".", markerfacecolor=style.BLUE
    ),
    "subharmonic": style.markers("released to the one-third subharmonic", style.VERMILION, "^"),
    "resonance": style.markers("released to the resonance motion", style.BLACK, "+"),
    "other": style.markers("released to another motion", style.GREEN, "d"),
    "unresolved": style.markers("not settled after the release", style.ORANGE, "*"),
}
MOTIONS = {  # motion before the release -> title of the panel
    "unsettled": "before it has settled",
    "quiet": "quiet motion",
    "violent": "violent motion",
    "subharmonic": "subharmonic motion",
}
DAMPER = "mass_ratio", "clearance", "restitution"


@style.context({"axes.titley": None})  # keeps the panel letters clear of the upper axis
def draw_migration(*, migration):
    """Draw one run of each case over time: the whole run, and the part around its last release."""
    drawn = style.figure("double", 0.7 + 3.6 * len(migration))
    panels = drawn.subplots(2 * len(migration), 1, squeeze=False)[:, 0]
    for runs, whole, part in zip(migration, panels[::2], panels[1::2], strict=True):
        run = runs.isel(trial=int(runs["example"]))
        period = 2 * np.pi / parameters_of(run)["frequency"]
        migration_plot(run, whole)
        migration_plot(run, part, np.nanmax(run["off_time"]) + period * np.array(AROUND))
        above = whole.secondary_xaxis("top", (lambda t, p=period: t / p, lambda n, p=period: n * p))
        above.set_xlabel(r"Cycles of the forcing, $\Omega T / 2 \pi$")
        whole.set(xlabel="", ylabel="")
        part.set_ylabel("")
    drawn.supylabel(style.axis_label(migration[0]["displacement"]), fontsize="medium")
    style.letter_panels(panels)
    style.legend(drawn, 3)
    return drawn


@style.context()
def draw_release(*, migration):
    """Draw the states at which the damper is switched off; markers show the motion that follows."""
    sources = [(runs, row) for runs in migration for row in range(runs.sizes["damped"])]
    columns = 3 if len(sources) % 3 == 0 else 2
    drawn, panels = style.grid(len(sources), 2.6, 0.6, columns)
    for axes, (runs, row) in zip(panels, sources, strict=True):
        _draw_releases(axes, runs.isel(damped=row))
    # Of three panels side by side only the middle panel has a label: three labels would overlap.
    for axes in panels[1::3] if columns == 3 else panels:
        axes.set_xlabel(style.axis_label(migration[0]["release_displacement"]))
    drawn.supylabel(style.axis_label(migration[0]["release_velocity"]), fontsize="medium")
    style.legend(drawn, 3)
    return drawn


def _draw_releases(axes, releases):
    reached = decode(releases["release_destination"]).values
    for destination, look in DESTINATIONS.items():
        chosen = reached == destination
        if chosen.any():
            x, y = releases["release_displacement"], releases["release_velocity"]
            axes.plot(x[chosen], y[chosen], **look)
    axes.set_title(MOTIONS[named(releases, "damped_kind")])


@style.context({"axes.titley": None})
def draw_basins(*, basins):
    """Draw basins with attractors and unstable orbits, one panel for each dataset."""
    drawn, panels = style.grid(len(basins), 3.4 if len(basins) > 1 else 4.6, 0.2)
    for axes, data in zip(panels, basins, strict=True):
        basins_plot(data, axes)
    return drawn


@style.context({"axes.titley": None})
def draw_release_policies(*, release_policies):
    """Draw how often and how fast each release policy succeeds, for each damper."""
    (data,) = release_policies
    drawn = style.figure("double", 5.2)
    panels = drawn.subplots(2, data.sizes["case"], sharex=True, sharey="row", squeeze=False)
    for case, (above, below) in enumerate(panels.T):
        one = data.isel(case=case)
        damper = {name: float(one[f"case_{name}"]) for name in DAMPER}
        above.set_title(style.parameter_label(damper, *DAMPER), fontsize=7.5, loc="right")
        _draw_case(above, below, one)
    panels[0, 0].set_ylabel("Share within 350 cycles")
    panels[1, 0].set_ylabel("Median of the cycles")
    style.letter_panels(panels.ravel())
    style.legend(drawn, 3)
    return drawn


def _draw_case(above, below, one):
    frequency = one["frequency"].values
    for k, policy in enumerate(one["policy"].values):
        look = style.curve(k) | {"marker": style.CURVES[k][2], "label": POLICIES[policy]}
        success = one["policy_success"].sel(policy=policy).values
        spread = np.abs(success[:, 1:] - success[:, :1]).T
        # Each curve is shifted a little in frequency, so that no error bar hides another.
        above.errorbar(frequency + 0.004 * (k - 1.5), success[:, 0], spread, capsize=1.5, **look)
        cycles = one["policy_cycles"].sel(policy=policy, quantile=0.5).values
        middle = np.where(np.isfinite(cycles[:, 0]), cycles[:, 0], np.nan)
        # A confidence interval without upper end is drawn up to the edge of the panel.
        spread = middle - cycles[:, 1], np.minimum(cycles[:, 2], 1e6) - middle
        below.errorbar(frequency + 0.004 * (k - 1.5), middle, spread, capsize=1.5, **look)
    ends = frequency[0] - 0.03, frequency[-1] + 0.03
    above.set(xlim=ends, ylim=(-0.05, 1.05))
    below.set(yscale="log", ylim=(8, 400), xlabel=style.axis_label(one["frequency"]))
