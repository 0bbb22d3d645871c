"""Figures of responses (2 to 5, 8 and 10 of the paper), of branches and of shares of starts."""

from impact_damper.data.datasets import flag, has_damper, is_settled, parameters_of
from impact_damper.plot import style
from impact_damper.plot.branches import branch as branch_plot
from impact_damper.plot.branches import runs
from impact_damper.plot.motions import phase_panel
from impact_damper.plot.responses import response as response_plot
from impact_damper.plot.stacked_shares import shares as shares_plot

# Lines of stable and unstable orbits without a damper, drawn behind all others.
FREE = {"color": style.BLACK, "linewidth": 0.7, "zorder": 2.2}
FREE_UNSTABLE = {"color": style.GREY, "linewidth": 0.7, "linestyle": ":", "zorder": 2.1}


@style.context()
def draw_free(*, branches):
    """Draw the largest displacement of orbits without a damper, one panel for each oscillator."""
    drawn = style.figure("double", 3.4)
    panels = drawn.subplots(1, len(branches), squeeze=False)[0]
    for axes, free in zip(panels, branches, strict=True):
        response_plot(free, axes)
        value = free["followed_value"].values
        axes.set_xlim(value.min(), value.max())
    style.letter_panels(panels)
    style.legend(drawn, 2)
    return drawn


@style.context()
def draw_harmonic_balance(*, harmonic_balance):
    """Draw the amplitude by harmonic balance against frequency, one panel for each damper."""
    drawn = style.figure("double", 3.2)
    panels = drawn.subplots(1, len(harmonic_balance), sharey=True, squeeze=False)[0]
    for axes, balance in zip(panels, harmonic_balance, strict=True):
        response_plot(balance, axes)
        axes.set(
            title=f"$d_0 = {parameters_of(balance)['clearance']:.3g}$",
            xlim=balance["frequency"].values[[0, -1]],
        )
    for axes in panels[1:]:
        axes.set_ylabel("")
    panels[0].autoscale(axis="y")
    panels[0].set_ylim(bottom=0)
    style.legend(drawn, 2)
    return drawn


@style.context()
def draw_motion(*, motion):
    """Draw velocity against displacement and mark the contacts, one panel for each motion."""
    drawn = style.figure("single" if len(motion) == 1 else "double", 3.2)
    panels = drawn.subplots(1, len(motion), squeeze=False)[0]
    for axes, traced in zip(panels, motion, strict=True):
        phase_panel(axes, traced)
    style.letter_panels(panels)
    style.legend(drawn, 2)
    return drawn


@style.context()
def draw_response(*, response, harmonic_balance, subharmonic, branches):
    """Draw displacement against frequency, one panel for each restitution."""
    free = [orbits for orbits in branches if not has_damper(orbits)]
    kinds = sorted({_restitution(motions) for motions in response}, reverse=True)
    drawn = style.figure("double", 1.7 + 3.3 * len(kinds))
    panels = drawn.subplots(len(kinds), squeeze=False, sharex=True)[:, 0]
    for axes, kind in zip(panels, kinds, strict=True):
        damped = [
            each
            for each in [*branches, *harmonic_balance, *response]
            if has_damper(each) and _restitution(each) == kind
        ]
        same = [each for each in subharmonic if has_damper(each) and _restitution(each) == kind]
        response_plot([*free, *damped, *map(_period_3, same)], axes)
        axes.label_outer()
        if len(kinds) > 1:
            axes.set_title(f"$e = {kind:g}$")
    panels[-1].set_xlim(response[0]["frequency"].values[[0, -1]])
    style.letter_panels(panels)
    style.legend(drawn, 3)
    return drawn


def _restitution(data):
    return parameters_of(data)["restitution"]


def _period_3(motions):
    period = motions["period"]
    chosen = is_settled(motions) & (period > 1) & (period % 3 == 0)
    outcome = motions["outcome"].where(chosen, flag("outcome", "absent"))
    return motions.assign(outcome=outcome)


@style.context()
def draw_branches(*, branches):
    """Draw max |Z1| of orbits with and without damper over frequency, a panel for each damper."""
    damped = [data for data in branches if has_damper(data)]
    free = [data for data in branches if not has_damper(data)]
    drawn = style.figure("double", 4.6 * len(damped))
    panels = drawn.subplots(len(damped), squeeze=False)[:, 0]
    for axes, data in zip(panels, damped, strict=True):
        for each in free:
            for value, size, stable in runs(each, lambda period: True):
                look = FREE if stable else FREE_UNSTABLE
                axes.plot(value, size, **look)
        branch_plot(data, axes)
        axes.set_ylim(bottom=0)
    style.legend(drawn, 4)
    return drawn


@style.context()
def draw_shares(*, response):
    """Draw the share of random starts that lead to each motion, one panel for each damper."""
    drawn, panels = style.grid(len(response), 2.3, 0.8, sharey=True)
    for place, (axes, data) in enumerate(zip(panels, response, strict=True)):
        shares_plot(data, axes)
        words = style.parameter_label(parameters_of(data), "mass_ratio", "clearance", "restitution")
        unseen = f"not seen: at most {100 * float(data['missed_share']):.2g} %"
        axes.set_title(f"{words}; {unseen}", loc="right", fontsize=8)
        if place % 2:
            axes.set_ylabel("")
    style.legend(drawn, 4)
    return drawn
