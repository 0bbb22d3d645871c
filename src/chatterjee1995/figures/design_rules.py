"""Optimum clearances of the exact motion, and rules for them (figure kind `design_rules`).

A rule gives the product rm W^2 d0 of mass ratio, squared frequency and clearance at the optimum.
By equation (18) of the paper, which follows from harmonic balance, it is 1.
"""

import numpy as np

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.plot.panels.style import (
    BLACK,
    GREY,
    ORANGE,
    SKY,
    axis_label,
    curve,
    figure,
    legend,
    letter_panels,
    parameter_label,
    points,
    style,
)

CAPTION = """
Above: clearance at which max |Z1| of the exact quiet orbit is smallest. Points: stable orbits;
crosses: unstable ones. Lines: model of flight at constant speed between the walls, with
corrections. Below: share of optima that each rule predicts within a given error. The explicit
formula is for elastic contact.
"""

# Parameters that a dataset can sweep, with the scale of their axis.
SWEPT = {
    "restitution": "linear",
    "contact_stiffness": "log",
    "frequency": "linear",
}
TITLES = {
    "displacement": "optimum of the largest displacement",
    "first_harmonic": "optimum of the first harmonic",
}
RULES = {
    "balance": "$1$, equation (18)",
    "gap_harmonic": r"$\pi^2/8$",
    "straight_flight": "straight flight, rigid walls",
    "elastic": "explicit, elastic contact",
    "flight": "flight with corrections",
}
LOOKS = {
    "balance": {"color": BLACK, "linestyle": (0, (1, 2))},
    "gap_harmonic": {"color": GREY, "linestyle": (0, (6, 3))},
    "straight_flight": {"color": SKY, "linestyle": (0, (6, 1.5, 1, 1.5))},
    "elastic": {"color": ORANGE},
    "flight": {"color": BLACK, "linewidth": 1.8},
}


@style()
def draw_design_rules(*, design_rules):
    """Draw optima and rules against each swept parameter, and the distribution of all errors.

    Parameters
    ----------
    design_rules : list of xarray.Dataset
        Datasets of the stage design_rules. A dataset in which exactly one parameter is swept in
        addition to the mass ratio gets a panel. The errors in the last row are those of all
        datasets.

    Returns
    -------
    matplotlib.figure.Figure
    """
    sweeps = [(data, swept(data)) for data in design_rules]
    sweeps = [(data, names[0]) for data, names in sweeps if len(names) == 1]
    rows = -(-len(sweeps) // 2) + 1
    drawn = figure("double", 1.9 * rows + 1.3)
    panels = drawn.subplots(rows, 2, squeeze=False)
    upper = panels[:-1].ravel()
    for axes, (data, name) in zip(upper, sweeps, strict=False):
        draw_sweep(axes, data.sel(criterion="displacement"), name)
    for axes in upper[len(sweeps) :]:
        axes.set_axis_off()
    for axes, (criterion, words) in zip(panels[-1], TITLES.items(), strict=True):
        draw_errors(axes, [data.sel(criterion=criterion) for data in design_rules])
        axes.set_title(words)
    letter_panels([*upper[: len(sweeps)], *panels[-1]])
    legend(drawn, 3)
    return drawn


def swept(data):
    """Return the names of the parameters, except the mass ratio, that have several values."""
    return [name for name in SWEPT if data.sizes[name] > 1]


def draw_sweep(axes, data, name):
    """Draw optima (points) and rules (lines) against one parameter, for each mass ratio."""
    data = data.squeeze([other for other in SWEPT if other != name], drop=True)
    unstable = data["best_stability"] == flag("best_stability", "unstable")
    for index, mass_ratio in enumerate(data["mass_ratio"].values):
        one = data.sel(mass_ratio=mass_ratio)
        axes.plot(
            one[name],
            one["best_ratio"],
            **points(index),
            label=f"$r_m = {mass_ratio:g}$: optimum, and flight with corrections (line)",
        )
        axes.plot(one[name], one["rule_ratio"].sel(rule="flight"), **curve(index))
    for rule in ("balance", "gap_harmonic"):
        level = data["rule_ratio"].sel(rule=rule).values.flat[0]
        axes.axhline(level, **LOOKS[rule], label=RULES[rule])
    crossed = data["best_ratio"].where(unstable).stack(cell=[...])
    axes.plot(
        crossed[name],
        crossed,
        color=BLACK,
        marker="x",
        linestyle="none",
        markersize=5.5,
        label="optimum with an unstable motion",
    )
    words = parameter_label(parameters_of(data), "damping", "linear_frequency")
    axes.set(
        xlabel=f"{axis_label(data[name])} ({words})",
        xscale=SWEPT[name],
        ylabel=r"$r_m \Omega^2 d_0$",
    )


def draw_errors(axes, datasets):
    """Draw the share of optima that each rule predicts within an error, against this error."""
    for rule, words in RULES.items():
        errors = np.concatenate(
            [
                np.abs(data["rule_ratio"].sel(rule=rule) / data["best_ratio"] - 1).values.ravel()
                for data in datasets
            ]
        )
        known = np.sort(100 * errors[np.isfinite(errors)])
        share = np.arange(1, len(known) + 1) / len(known)
        axes.step(known, share, where="post", **LOOKS[rule], label=words)
    axes.set(
        xscale="log", xlim=(1e-2, 300), xlabel="Error of the rule, %", ylabel="Share of optima"
    )
