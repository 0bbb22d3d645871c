"""Envelopes of transients: largest |Z1| and number of contacts in successive windows of time.

Each window has its own parameters. The kernel of a step requires a fixed forcing frequency. In a
sweep the frequency is fixed in each forcing cycle and changes at the strobe, the phase W T = pi/2,
where the force is zero. Therefore neither the phase of the forcing nor the force jumps.

Z1 is the displacement of the primary mass, W the forcing frequency, and T the time.
"""

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER
from impact_damper.kernel.single import X, side_of, step, workspace
from impact_damper.motions.extrema import extremum
from impact_damper.motions.strobe_map import strobe_time

# Number of windows in one call of the kernel. Ctrl-C waits for the end of the call, so a call must
# be short; it takes a few milliseconds.
AT_ONCE = 1024


def envelope(parameters, lengths, y, tolerance):
    """Run a motion through successive windows of time.

    Parameters
    ----------
    parameters : array, shape (n, packed.COUNT)
        Packed parameters in each window.
    lengths : array, shape (n,)
        Lengths of the windows in units of T. Each window begins at the strobe, W T = pi/2, so with
        forcing its length must be a forcing cycle 2 pi/W.
    y : array, shape (4,)
        First state, replaced by the last state or by the state at an escape.
    tolerance : float
        Largest local error of a step.

    Returns
    -------
    largest : numpy.ndarray, shape (n,)
        Largest |Z1| in each window; infinite where the motion escapes, and NaN afterwards.
    contacts : numpy.ndarray, shape (n,)
        Number of contacts begun in each window, NaN from the window of an escape on.
    """
    largest, contacts = np.full((2, len(lengths)), np.nan)
    side = side_of(next(iter(parameters)), y)
    for first in range(0, len(lengths), AT_ONCE):
        part = slice(first, first + AT_ONCE)
        side, escaped = run_windows(
            parameters[part], lengths[part], y, side, tolerance, largest[part], contacts[part]
        )
        if escaped:
            break
    return largest, contacts


@kernel
def run_windows(parameters, lengths, y, side, tolerance, largest, contacts):
    """Fill `largest` and `contacts` of `envelope`.

    Return the wall in contact, and whether the motion escaped.
    """
    work = workspace()
    for k in range(len(lengths)):
        p = parameters[k]
        t = strobe_time(p)
        end = t + lengths[k]
        farthest, begun = abs(y[0]), 0
        while t < end:
            before = side
            length, side = step(p, y, side, t, end - t, tolerance, work)
            if has_escaped(p, y[0], y[1]):
                largest[k] = np.inf
                return side, True
            order = FLIGHT_ORDER if before == 0 else CONTACT_ORDER
            farthest = extremum(work[X:], order, length, farthest)
            begun += before == 0 and side != 0
            t = end if length >= end - t else t + length
        largest[k], contacts[k] = farthest, begun
    return side, False
