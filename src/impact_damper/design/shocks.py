"""Robustness of a design: impulses on the machine, and the time until motions are small again.

Terms from Attractors.jl 2: minimal critical shock, convergence time, finite-time basin stability.
"""

import numpy as np
import xarray as xr

from impact_damper.design.cells import Cell, draw_starts, peaks_of_blocks, run
from impact_damper.design.task import labelled
from impact_damper.model.packed import FREQUENCY

# There are SHOCKS positive and SHOCKS negative impulses. The largest impulse changes the machine's
# velocity by WIDEST x W A. W is the angular frequency of the force. A is the largest displacement
# without damper or, if this is infinite, the promised displacement.
SHOCKS, WIDEST = 32, 2.0
# A motion runs for LONGEST cycles. Its peak is found in each block of BLOCK cycles.
LONGEST, BLOCK = 1000, 10
LIMITS = (10, 30, 100, 300, 1000 - BLOCK)  # convergence times of the finite-time basin stability


def shocks(task, decision, progress=None) -> xr.Dataset:
    """Return a dataset of the times after which motions stay below the promised displacement.

    Some motions begin at random starts. In the other motions an impulse acts on the machine, at a
    fixed phase of the forcing. Before the impulse, the machine is in the smallest of the motions
    that random starts lead to. All values are nominal, the frequency is `promised_frequency`.
    """
    frequency = float(decision["promised_frequency"])
    cell = Cell(1e-3 * float(decision["design_gap"]), frequency)
    promised = float(decision["promised_displacement"]) / task.millimetres(1.0)
    motions = run(task, [cell], task.effort.starts, ("shocks",), progress)
    p = motions.parameters[0]
    state = motions.states[0, np.argmin(motions.peaks[0])]
    bare = task.bare_at([frequency])[0] / task.millimetres(1.0)
    most = WIDEST * p[FREQUENCY] * bare if np.isfinite(bare) else WIDEST * p[FREQUENCY] * promised
    changes = most * np.arange(1, SHOCKS + 1) / SHOCKS
    changes = np.concatenate([-changes[::-1], changes])
    returned = times_after(task, p, state, changes, promised)
    drawn = draw_starts(task, [cell], task.effort.starts, ("shocks", 1))[0]
    starts = convergence_times(task, p, drawn, promised)
    critical = np.abs(changes)[np.isinf(returned)].min(initial=np.inf)
    # After an impulse of the size `critical` the motion stays large. Try slightly smaller impulses.
    first = changes[np.isinf(returned) & (np.abs(changes) <= critical)]
    steps = most / SHOCKS * np.arange(SHOCKS) / SHOCKS
    fine = (first[:, None] - np.sign(first)[:, None] * steps).ravel()
    away = np.isinf(times_after(task, p, state, fine, promised))
    critical = np.abs(fine)[away].min(initial=critical)
    values = {
        "shock_return": returned,
        "critical_shock": task.scales.to_si(critical, "impulse"),
        "returned_share": [np.mean(starts <= limit) for limit in LIMITS],
    }
    impulses = task.scales.to_si(changes, "impulse")
    return labelled(values, shock_impulse=impulses, return_limit=np.array(LIMITS))


def times_after(task, p, state, changes, promised):
    """Return convergence times from `state` with changes[i] added to the machine's velocity."""
    states = np.tile(state, (len(changes), 1))
    states[:, 1::2] += np.asarray(changes)[:, None]
    return convergence_times(task, p, states, promised)


def convergence_times(task, p, states, promised) -> np.ndarray:
    """Return the cycles until each motion from `states` stays below `promised`, or infinity."""
    rows = np.tile(p, (len(states), 1))
    peaks = peaks_of_blocks(task, rows, states.copy(), LONGEST // BLOCK, BLOCK)
    loud = peaks > promised
    last = np.where(loud.any(axis=1), loud.shape[1] - np.argmax(loud[:, ::-1], axis=1), 0)
    return np.where(loud[:, -1], np.inf, BLOCK * last)
