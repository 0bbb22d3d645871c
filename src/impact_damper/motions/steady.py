"""Find the steady motion to which a state leads; run many motions on several threads.

This module imports no kernels that run motions side by side, because they take long to compile.
"""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
from tqdm import tqdm

from impact_damper.data.datasets import dataset, is_settled, named
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import assign, side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model import bounds
from impact_damper.model.arguments import read_forced, read_start, read_state
from impact_damper.model.settling import check_settling
from impact_damper.motions.records import MOTION, follow_each, measure, tabulate
from impact_damper.motions.simulate import COMPONENTS, simulate
from impact_damper.motions.strobe_map import STROBE, one_period, strobe_time
from impact_damper.motions.undecided import name_undecided
from impact_damper.motions.watch import RING, SEEN, begin_watch, watch

# Number of motions in a chunk. A call of a kernel runs one or more chunks.
CHUNK = 128
# MOST_CHUNKS: largest number of chunks in one call of a kernel. Ctrl-C waits until the call ends.
# SLICES: if there are enough motions, each of several threads gets at least SLICES calls.
MOST_CHUNKS, SLICES = 8, 3


@bounds.names_arguments
def steady_motion(
    system, damper, frequency, state=(0.0, 0.0, 0.0, 0.0), *, start=None, settling=None
):
    """Return the steady motion that a state leads to.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
    frequency : float
        Forcing frequency W, or Hz for a machine.
    state, start
        As in `simulate`.
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        Outcome (see `decode`), period, contacts per forcing cycle, largest |Z1|, asymmetry (0 if
        the motion becomes its mirror image in half a period), phase of Z1 minus phase of Z2, phase
        of Z1 minus phase of the loose mass (phases of first harmonics), dominant multiplier,
        Lyapunov exponent, frequencies of a quasi-periodic motion. `state` is the state at
        W T = pi/2 (a coordinate). To continue, pass `state` to `simulate` or this function.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper, state = idm.Oscillator(0.215), idm.Damper(0.12, 2.0), (0, 0, 0, 0)
    >>> upward = []
    >>> for frequency in (1.9, 2.0, 2.1):
    ...     steady = idm.steady_motion(oscillator, damper, frequency, state)
    ...     state = steady.state
    ...     upward.append(steady)
    """
    settling = check_settling(settling)
    model = read_forced(system, damper, frequency)
    p = model.pack()
    y = read_state(model, state)
    start = read_start(model, state, start)
    # Shift the start by whole forcing cycles into the cycle that ends at the first strobe.
    strobe, period = STROBE / model.frequency, 2 * np.pi / model.frequency
    begin = min(start - np.ceil((start - strobe) / period - 1e-9) * period, strobe)
    record = settle_with(ONE_BY_ONE, p[None], y[None], np.array([begin]), settling)[0]
    data = {name: ((), value) for name, value in tabulate(record).items()}
    data |= {"state": (("component",), record["state"]), "state_phase": STROBE}
    parameters = model.describe(settling) | {"state": y.tolist(), "start": start}
    coordinates = {"component": list(COMPONENTS), "frequency": ((), model.frequency)}
    return dataset(data, coordinates, parameters, "Steady motion of the oscillator", model)


def steady_orbit(system, damper, frequency, state, *, samples=200, settling=None):
    """Return one period of the steady motion that a state leads to: a dataset as from `simulate`.

    The period begins at W T = pi/2. Raise ArithmeticError if the state leads to no periodic orbit.
    """
    settling = check_settling(settling)
    steady = steady_motion(system, damper, frequency, state, settling=settling)
    if not is_settled(steady):
        raise ArithmeticError(
            f"{named(steady, 'outcome')}: the state has led to no periodic orbit within "
            f"settling.limit = {settling.limit} forcing cycles; use simulate"
        )
    run = {"periods": int(steady["period"]), "samples": samples, "tolerance": settling.tolerance}
    return simulate(system, damper, frequency, steady["state"], **run)


def run_chunks(work, count, workers, progress, stop, size=CHUNK):
    """Divide range(count) into slices of length `size`; call `work(slice)` on `workers` threads.

    An error or Ctrl-C sets `stop[0]`. Then calls of `work` that still run end soon by themselves.
    """
    bounds.check_count("workers", workers, most=4096)
    slices = [slice(first, min(first + size, count)) for first in range(0, count, size)]
    pool = ThreadPoolExecutor(workers)
    try:
        with tqdm(total=count, desc=progress, disable=progress is None, mininterval=1.0) as bar:
            for part, _ in zip(slices, pool.map(work, slices), strict=True):
                bar.update(part.stop - part.start)
    except BaseException:
        stop[0] = True
        raise
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def settle_with(
    kernels, parameters, states, begins, settling, *, workers=1, progress=None, stop=None
):
    """Run m motions until their outcomes are known; return an array of m records (`MOTION`).

    The motions start in `states` (m, 4) at the times `begins` (m,). `kernels` is ONE_BY_ONE, to run
    one motion after the other, or `ensemble.SIDE_BY_SIDE`. Other arguments: see `ensemble.settle`.
    """
    settle, follow = kernels
    bounds.check_count("workers", workers, most=4096)
    states = np.ascontiguousarray(states, float)
    records = np.zeros(len(states), MOTION)
    stop = np.zeros(1, bool) if stop is None else stop
    settings = settling.tolerance, settling.patience, settling.limit

    def work(part):
        rows, out = parameters[part], records[part]
        settle(rows, states[part], begins[part], *settings, out, stop)
        # Results may depend on which motions share a chunk, so chunks do not depend on `workers`.
        for first in range(0, max(len(out), 1), CHUNK):
            some = slice(first, first + CHUNK)
            name_undecided(rows[some], out[some], settling.limit, settling.further, stop)
        measure(rows, settling, out, stop, follow)

    # This call compiles the kernels in the main thread, where Ctrl-C can interrupt the compilation.
    work(slice(0, 0))
    # Near the end of each call few motions run side by side, which is slow. So calls are large.
    # But each worker gets several calls, so that all workers finish at about the same time.
    share = len(states) // CHUNK if workers == 1 else len(states) // (SLICES * workers * CHUNK)
    size = CHUNK * min(max(share, 1), MOST_CHUNKS)
    run_chunks(work, len(states), workers, progress, stop, size=size)
    return records


@kernel
def settle_each(parameters, states, start, tolerance, patience, limit, out, stop):
    """Run motions as `ensemble.settle_many` does, but one after the other."""
    work, ring = workspace(), np.empty((RING, 4))
    seen, tangent = np.empty(1, SEEN), np.empty((1, 4))
    for i in range(len(out)):
        p, y = parameters[i], states[i].copy()
        begin_watch(seen[0], i, out[i])
        side, first = side_of(p, y), strobe_time(p)
        side, contacts, _ = advance(p, y, tangent[:0], side, start[i], first, tolerance, work)
        while not stop[0]:
            if watch(
                p, y, side, contacts, tangent[0], ring, seen[0], tolerance, patience, limit, out[i]
            ):
                break
            tangents = tangent if seen[0].strobes > patience // 2 else tangent[:0]
            side, contacts, _ = one_period(p, y, tangents, side, tolerance, work)
        assign(out[i].state, y)


ONE_BY_ONE = settle_each, follow_each
