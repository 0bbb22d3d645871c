"""Responses by harmonic balance with and without a damper: figure 3."""

import numpy as np

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.figures.branches import draw_lines, lines
from impact_damper.figures.style import ROLES, axis_label, figure, legend, style


@style()
def draw_harmonic_balance(*, harmonic_balance):
    """Amplitude by harmonic balance against forcing frequency, a panel for each damper.

    Parameters
    ----------
    harmonic_balance : list of xarray.Dataset
        Of `harmonic_balance`, with a damper.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 3.2)
    panels = drawn.subplots(1, len(harmonic_balance), sharey=True, squeeze=False)[0]
    for axes, balance in zip(panels, harmonic_balance, strict=True):
        draw_band(axes, balance)
        stable = balance["free_stability"].values == flag("free_stability", "stable")
        draw_amplitudes(axes, balance, "free_amplitude", stable, ROLES["free_stable"])
        draw_unstable(axes, balance)
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


def draw_balance(axes, balance):
    """Stable solutions of (7) with the damper in contact."""
    stable = balance["stability"].values == flag("stability", "stable")
    impacting = balance["kind"].values == flag("kind", "impacting")
    draw_amplitudes(axes, balance, "amplitude", stable & impacting, ROLES["harmonic_balance"])


def draw_amplitudes(axes, balance, name, chosen, role):
    """Absolute amplitudes of the chosen solutions of harmonic balance."""
    group = np.where(chosen, 0, -1)
    found = lines(balance["frequency"].values, balance[name].values, group)
    draw_lines(axes, [(at, abs(values)) for _, at, values in found], role)


def draw_band(axes, balance):
    """The suppression band, shaded, where there is one."""
    if balance["band_status"] == flag("band_status", "found"):
        axes.axvspan(*balance["edge_frequency"].values, **ROLES["band"])


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
