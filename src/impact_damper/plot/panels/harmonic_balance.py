"""Responses by harmonic balance, with and without a damper (paper: figure 3).

Figure kind `harmonic_balance`. (7) is the paper's system of equations for solutions with contact.
"""

import numpy as np

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.plot.panels.style import ROLES, axis_label, figure, legend, style

CAPTION = """
Amplitude by harmonic balance, equations (7), against forcing frequency, one panel for each
clearance. Thick: stable solutions with contact. Thin: without the damper. The suppression band is
the range around the peak in which (7) has a single stable solution with contact, smaller than the
free resonance.
"""


@style()
def draw_harmonic_balance(*, harmonic_balance):
    """Draw the amplitude by harmonic balance against frequency, one panel for each damper.

    Parameters
    ----------
    harmonic_balance : list of xarray.Dataset
        Datasets of the stage harmonic_balance, with a damper.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 3.2)
    panels = drawn.subplots(1, len(harmonic_balance), sharey=True, squeeze=False)[0]
    for axes, balance in zip(panels, harmonic_balance, strict=True):
        draw_band(axes, balance)
        draw_free(axes, balance)
        draw_balance(axes, balance)
        axes.set(
            title=f"$d_0 = {parameters_of(balance)['clearance']:.3g}$",
            xlabel=axis_label(balance["frequency"]),
            xlim=balance["frequency"].values[[0, -1]],
        )
    panels[0].set(ylabel="Amplitude of the primary mass, $|a|$")
    panels[0].set_ylim(bottom=0)
    legend(drawn, 2)
    return drawn


def draw_free(axes, balance):
    """Draw the solutions without the damper, stable and unstable."""
    stable = balance["free_stability"].values == flag("free_stability", "stable")
    draw_amplitudes(axes, balance, "free_amplitude", stable, ROLES["free_stable"])
    draw_unstable(axes, balance)


def draw_balance(axes, balance):
    """Draw the stable impacting solutions of (7)."""
    stable = balance["stability"].values == flag("stability", "stable")
    impacting = balance["kind"].values == flag("kind", "impacting")
    draw_amplitudes(axes, balance, "amplitude", stable & impacting, ROLES["harmonic_balance"])


def draw_amplitudes(axes, balance, name, chosen, role):
    """Draw |a| of the solutions where the mask `chosen` is True; `role` is a value of `ROLES`."""
    size = np.where(chosen, abs(balance[name].values), np.nan)
    for branch in size.T[np.isfinite(size).any(axis=0)]:
        axes.plot(balance["frequency"].values, branch, **role)


def draw_band(axes, balance):
    """Shade the suppression band, if it exists."""
    if "band_status" in balance and balance["band_status"] == flag("band_status", "found"):
        axes.axvspan(*balance["edge_frequency"].values, **ROLES["band"])


def draw_unstable(axes, balance):
    """Draw the unstable solutions of harmonic balance without a damper, up to the folds.

    Along the response curve the phase increases, so the solutions are sorted by phase.
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
