"""Figures of best clearances (6, 7 and 11 of the paper), of rules for them, and of studies."""

from itertools import product

import numpy as np
from matplotlib.colors import LogNorm

from impact_damper.data.datasets import decode, parameters_of
from impact_damper.plot import style
from impact_damper.plot.maps import edges_of, hatch, mesh
from impact_damper.plot.sweeps import OPTIMUM
from impact_damper.plot.sweeps import sweep as sweep_plot

UNSTABLE = style.markers("optimum with an unstable motion", style.BLACK, "x", markersize=5.5)
SWEPT = {"restitution": "linear", "contact_stiffness": "log", "frequency": "linear"}
TITLES = {
    "displacement": "optimum of the largest displacement",
    "first_harmonic": "optimum of the first harmonic",
}
RULES = {
    "balance": style.line("$1$, equation (18)", style.BLACK, linestyle=(0, (1, 2))),
    "gap_harmonic": style.line(r"$\pi^2/8$", style.GREY, linestyle=(0, (6, 3))),
    "straight_flight": style.line(
        "straight flight, rigid walls", style.SKY, linestyle=(0, (6, 1.5, 1, 1.5))
    ),
    "elastic": style.line("explicit, elastic contact", style.ORANGE),
    "flight": style.line("flight with corrections", style.BLACK, linewidth=1.8),
}
# Hatching of map cells in which some motions with contacts have not settled.
UNSETTLED = {"hatch": "////", "edgecolor": style.BLACK, "linewidth": 0}


@style.context()
def draw_optimum(*, optimum):
    """Draw the largest displacement of the quiet motion over the clearance, for each sweep."""
    drawn = style.figure("double", 4.4)
    sweep_plot(optimum, drawn.subplots())
    style.legend(drawn, 3)
    return drawn


@style.context()
def draw_design_rules(*, design_rules):
    """Draw the best clearance, and the clearance by each rule, and the errors of the rules."""
    swept = [[name for name in SWEPT if data.sizes[name] > 1] for data in design_rules]
    sweeps = [
        (d, names[0]) for d, names in zip(design_rules, swept, strict=True) if len(names) == 1
    ]
    drawn, panels = style.grid(len(sweeps) + len(TITLES), 1.9, 1.3)
    for axes, (data, name) in zip(panels, sweeps, strict=False):
        _draw_sweep(axes, data.sel(criterion="displacement"), name)
    for axes, (criterion, words) in zip(panels[len(sweeps) :], TITLES.items(), strict=True):
        _draw_errors(axes, [data.sel(criterion=criterion) for data in design_rules])
        axes.set_title(words)
    style.legend(drawn, 3)
    return drawn


def _draw_sweep(axes, data, name):
    data = data.squeeze([other for other in SWEPT if other != name], drop=True)
    for index, mass_ratio in enumerate(data["mass_ratio"].values):
        one = data.sel(mass_ratio=mass_ratio)
        words = f"$r_m = {mass_ratio:g}$: optimum, and flight with corrections (line)"
        axes.plot(one[name], one["best_ratio"], **style.points(index), label=words)
        axes.plot(one[name], one["rule_ratio"].sel(rule="flight"), **style.curve(index))
    for rule in ("balance", "gap_harmonic"):
        level = data["rule_ratio"].sel(rule=rule).values.flat[0]
        axes.axhline(level, **RULES[rule])
    unstable = decode(data["best_stability"]) == "unstable"
    crossed = data["best_ratio"].where(unstable).stack(cell=[...])
    axes.plot(crossed[name], crossed, **UNSTABLE)
    words = style.parameter_label(parameters_of(data), "damping", "linear_frequency")
    axes.set(
        xlabel=f"{style.axis_label(data[name])} ({words})",
        xscale=SWEPT[name],
        ylabel=r"$r_m \Omega^2 d_0$",
    )


def _draw_errors(axes, datasets):
    for rule, look in RULES.items():
        errors = np.concatenate(
            [
                np.abs(data["rule_ratio"].sel(rule=rule) / data["best_ratio"] - 1).values.ravel()
                for data in datasets
            ]
        )
        axes.ecdf(100 * errors[np.isfinite(errors)], **look)
    axes.set(
        xscale="log", xlim=(1e-2, 300), xlabel="Error of the rule, %", ylabel="Share of optima"
    )


@style.context()
def draw_studies(*, studies):
    """Draw maps of the largest displacement, one for each restitution and forcing frequency."""
    (data,) = studies
    pairs = list(product(data["restitution"].values, data["frequency"].values))
    rows, columns = data.sizes["restitution"], data.sizes["frequency"]
    drawn = style.figure("single" if columns == 1 else "double", 3.6 * rows)
    panels = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    sizes = data["largest_displacement"].values
    sizes = sizes[np.isfinite(sizes)]
    norm = LogNorm(sizes.min(), sizes.max())
    for axes, (e, w) in zip(panels.flat, pairs, strict=True):
        shown = _draw_study(axes, data.sel(frequency=w, restitution=e), norm)
        if len(pairs) > 1:
            axes.set_title(rf"$\Omega = {w:g}$, $e = {e:g}$")
    for axes in panels[:, 0]:
        axes.set_ylabel(style.axis_label(data["clearance"]))
    for axes in panels[-1]:
        axes.set_xlabel(style.axis_label(data["mass_ratio"]))
    drawn.colorbar(shown, ax=panels, label="Largest displacement that starts lead to")
    style.legend(drawn, 1 if columns == 1 else 3)
    return drawn


def _draw_study(axes, data, norm):
    plane = data["mass_ratio"].values, data["clearance"].values
    shown = mesh(axes, *plane, data["largest_displacement"].values.T, norm)
    settled = data["outcome_count"].sel(counted_outcome=["settled", "non_colliding"])
    part = settled.sum("counted_outcome").values.T < parameters_of(data)["starts"]
    hatch(axes, *plane, part, label="not all motions settled", **UNSETTLED)
    axes.plot(plane[0], data["rule_clearance"], color=style.BLACK, label=r"$r_m \Omega^2 d_0 = 1$")
    best = OPTIMUM | {"label": "smallest at this mass ratio"}
    axes.plot(plane[0], data["best_clearance"], **best)
    axes.set_ylim(edges_of(plane[1])[[0, -1]])
    return shown
