"""Traces of motions: states at given times, and a log of the contacts."""

import numpy as np

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.single import LENGTH, assign, side_of, state_in_step, step, workspace

# STEPS_AT_ONCE: largest number of steps in one call of the kernel. Ctrl-C waits for the call.
# ROWS: number of rows of a new log of contacts. More rows are added when the log is full.
STEPS_AT_ONCE, ROWS = 50_000, 64


def trace(p, state, begin, times, tolerance):
    """Return a motion's states at increasing times, shape (n, 4), and contacts, shape (k, 5).

    The row of a contact holds the wall (-1 or 1), the times at which the contact begins and ends,
    and Z2' at these times. States after an escape are NaN.
    """
    y, t, times = np.array(state, float), float(begin), np.ascontiguousarray(times, float)
    states, log = np.empty((len(times), 4)), np.empty((ROWS, 5))
    side, contacts = side_of(p, y), 0
    if side != 0:
        log[0], contacts = (side, t, np.nan, y[3], np.nan), 1
    sample = int(np.searchsorted(times, t, side="right"))
    states[:sample] = y
    while sample < len(times):
        t, side, sample, contacts = trace_steps(
            p, y, t, side, sample, contacts, times, tolerance, states, log
        )
        if contacts == len(log):
            log = np.concatenate([log, np.empty_like(log)])
    return states, log[:contacts].copy()


def states_at(p, state, begin, times, tolerance):
    """Return the states of a motion at increasing times, shape (n, 4)."""
    return trace(p, state, begin, times, tolerance)[0]


@kernel
def trace_steps(p, y, t, side, sample, contacts, times, tolerance, states, log):
    """Integrate at most STEPS_AT_ONCE steps; write samples to `states` and contacts to `log`."""
    work = workspace()
    start = y.copy()
    for _ in range(STEPS_AT_ONCE):
        if sample == len(times) or contacts == len(log):
            break
        assign(start, y)
        before = side
        # The last step ends at the last sample, so y becomes the state at the last sample.
        left = times[-1] - t
        length, side = step(p, y, side, t, left, tolerance, work)
        gone = has_escaped(p, y[0], y[1])
        while sample < len(times) and (times[sample] - t < length or length >= left):
            x, v, z, w = state_in_step(work, before, start, min(times[sample] - t, length))
            if gone and times[sample] - t > work[LENGTH]:
                x, v, z, w = np.nan, np.nan, np.nan, np.nan
            states[sample, 0], states[sample, 1] = x, v
            states[sample, 2], states[sample, 3] = z, w
            sample += 1
        t += length
        if before == 0 and side != 0:
            contacts = record_beginning(log, contacts, side, t, y[3])
        elif before != 0 and side == 0:
            log[contacts - 1, 2], log[contacts - 1, 4] = t, y[3]
    return t, side, sample, contacts


@kernel_only
def record_beginning(log, contacts, side, t, speed):
    """If log[contacts] exists, begin a contact there with Z2' = `speed`. Return contacts + 1."""
    if contacts < len(log):
        log[contacts, 0], log[contacts, 1], log[contacts, 2] = side, t, np.nan
        log[contacts, 3], log[contacts, 4] = speed, np.nan
    return contacts + 1
