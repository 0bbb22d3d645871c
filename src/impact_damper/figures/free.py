"""Response of the free oscillator: figure 2."""

import numpy as np

from impact_damper.datasets import flag
from impact_damper.figures.branches import branch_lines, draw_lines
from impact_damper.figures.style import ROLES, axis_label, figure, legend, letter_panels, style


@style()
def draw_free(*, free, free_design):
    """Largest displacement of the free motions against forcing frequency, a panel for each.

    Parameters
    ----------
    free : list of xarray.Dataset
        Of `frequency_response` without a damper.
    free_design : list of xarray.Dataset
        Of `harmonic_balance_response` for the same oscillators.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 3.4)
    panels = drawn.subplots(1, len(free), squeeze=False)[0]
    for axes, response, balance in zip(panels, free, free_design, strict=True):
        draw_free_branches(axes, response, balance)
        axes.set(
            xlabel=axis_label(response["frequency"]),
            ylabel=axis_label(response["maximum_displacement"]),
            xlim=response["frequency"].values[[0, -1]],
        )
        axes.set_ylim(bottom=0)
    if len(panels) > 1:
        letter_panels(panels)
    legend(drawn, 2)
    return drawn


def draw_free_branches(axes, response, balance):
    """Settled free motions, solid, and unstable solutions of harmonic balance, dashed."""
    period = response["period"].values
    settled = response["outcome"].values == flag("outcome", "settled")
    for chosen, role in (
        (settled & (period == 1), "free_stable"),
        (settled & (period == 3), "subharmonic_free"),
        (settled & (period != 1) & (period != 3), "free_higher"),
    ):
        draw_lines(axes, branch_lines(response, chosen), ROLES[role])
    draw_unstable(axes, balance)


def draw_unstable(axes, balance):
    """Unstable solutions of harmonic balance without a damper, up to the folds.

    The phase increases along the curve of all solutions: it puts them in order.
    """
    phase = balance["free_phase"].values
    order = np.argsort(phase, axis=None)[: np.isfinite(phase).sum()]
    frequency, amplitude, stability = (
        np.broadcast_to(values.T, phase.T.shape).T.ravel()[order]
        for values in (
            balance["frequency"].values,
            balance["free_amplitude"].values,
            balance["free_stability"].values,
        )
    )
    unstable = stability == flag("free_stability", "unstable")
    shown = np.convolve(unstable, [1, 1, 1], "same") > 0
    axes.plot(frequency, np.where(shown, amplitude, np.nan), **ROLES["free_unstable"])
