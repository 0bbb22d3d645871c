"""Frequency responses with and without a damper: figures 5, 8, 10 (figure kind `response`)."""

from impact_damper.data.datasets import flag, has_damper, is_settled, parameters_of
from impact_damper.figures.branches import draw_free_orbits, runs
from impact_damper.figures.harmonic_balance import draw_balance, draw_band
from impact_damper.figures.motion_lines import branch_lines, draw_lines
from impact_damper.figures.style import ROLES, axis_label, figure, legend, style

CAPTION = """
Largest displacement against forcing frequency of all motions that were found, from random starts
and by following each motion to the neighbouring frequencies. Lines join the settled motions of a
branch and extend to its ends. The motions without damper and the dotted unstable ones with damper
are exact periodic orbits. A chaotic motion is a point at the largest displacement observed. A
quasi-periodic motion has two frequencies without a common multiple, found from rotation numbers. A
motion without contact is one of the free oscillator, while the loose mass stands still or drifts in
the gap. A motion with damper is called subharmonic if
its period is a multiple of three forcing periods. Harmonic balance, for elastic contact only, gives
the amplitude of the first harmonic, which is below the largest displacement where higher harmonics
matter. The paper draws few motions at each frequency and calls the chaotic ranges narrow; here
several motions coexist at most frequencies, and all are drawn.
"""

JOINED = {"linestyle": "-", "linewidth": 0.5}
STATUSES = ("chaotic", "quasi_periodic", "non_colliding", "drifting", "unresolved")
FREE = {
    "chaotic": ROLES["chaotic"] | {"label": "free, chaotic"},
    "unresolved": ROLES["unresolved"] | {"label": "free, unresolved"},
}


@style()
def draw_response(*, response, harmonic_balance, subharmonic, branches):
    """Draw the largest displacement against frequency, all dampers of an oscillator in one plot.

    Parameters
    ----------
    response : list of xarray.Dataset
        Datasets of the stage response with a damper, elastic or inelastic.
    harmonic_balance : list of xarray.Dataset
        Datasets of the stage harmonic_balance of the elastic dampers.
    subharmonic : list of xarray.Dataset
        Datasets of the stage subharmonic.
    branches : list of xarray.Dataset
        Datasets of the stage branches, with and without a damper.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 5.0)
    axes = drawn.subplots()
    response_panel(axes, response, harmonic_balance, branches)
    for motions in subharmonic:
        draw_settled(axes, motions, ["subharmonic_damped"])
    first = response[0]
    axes.set(
        xlabel=axis_label(first["frequency"]),
        ylabel=axis_label(first["maximum_displacement"]),
        xlim=first["frequency"].values[[0, -1]],
    )
    axes.set_ylim(bottom=0)
    legend(drawn, 3)
    return drawn


def response_panel(axes, response, harmonic_balance, branches):
    """Draw motions, solutions of harmonic balance and exact orbits, with and without a damper."""
    for orbits in branches:
        if has_damper(orbits):
            draw_unstable_orbits(axes, orbits)
        else:
            draw_free_orbits(axes, orbits)
    for balance in harmonic_balance:
        if has_damper(balance):
            draw_band(axes, balance)
            draw_balance(axes, balance)
    for motions in response:
        if has_damper(motions):
            draw_motions(axes, motions)
        else:
            draw_free_motions(axes, motions)


def draw_free_motions(axes, motions):
    """Draw the motions without a damper: settled ones joined along branches, others as points."""
    settled = is_settled(motions)
    period = motions["period"].values
    for role, chosen in (("free_stable", period == 1), ("free_higher", period != 1)):
        draw_lines(axes, branch_lines(motions, settled & chosen), ROLES[role])
    draw_unsettled(axes, motions, FREE)


def draw_motions(axes, motions):
    """Draw the motions with a damper: settled ones joined along branches, others as points."""
    prefix = prefix_of(motions)
    draw_settled(axes, motions, ["period_1", "higher_period", "subharmonic_damped"], prefix)
    draw_unsettled(axes, motions, {status: ROLES[f"{prefix}{status}"] for status in STATUSES})


def draw_unsettled(axes, motions, roles):
    """Draw the motions that have not settled on an orbit as points; a role for each outcome."""
    for status, role in roles.items():
        row, column = (motions["outcome"].values == flag("outcome", status)).nonzero()
        if len(row):
            axes.plot(
                motions["frequency"].values[row],
                motions["maximum_displacement"].values[row, column],
                **role,
            )


def draw_unstable_orbits(axes, orbits):
    """Draw the unstable parts of the branches of orbits with a damper, of any period."""
    role = ROLES[f"{prefix_of(orbits)}unstable_orbit"]
    for value, size, stable in runs(orbits, lambda period: True):
        if not stable:
            axes.plot(value, size, **role)


def prefix_of(data):
    """Return the prefix of names in `style.ROLES`: "inelastic_" for restitution below 1, or ""."""
    return "inelastic_" if parameters_of(data)["restitution"] < 1 else ""


def draw_settled(axes, motions, roles, prefix=""):
    """Draw settled motions with contacts; those whose period is a multiple of 3 as subharmonic."""
    period = motions["period"].values
    colliding = is_settled(motions) & (motions["contacts"].values > 0)
    chosen = {
        "period_1": period == 1,
        "higher_period": (period > 1) & (period % 3 != 0),
        "subharmonic_damped": (period > 1) & (period % 3 == 0),
    }
    for role in roles:
        found = branch_lines(motions, colliding & chosen[role])
        draw_lines(axes, found, ROLES[f"{prefix}{role}"] | JOINED)
