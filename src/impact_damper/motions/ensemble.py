"""Run many motions on several threads, with a progress bar.

Kernels (compiled functions) release Python's global interpreter lock, so threads run in parallel.
Each motion is computed separately, so results do not depend on the number of threads.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass, W the
forcing frequency, and T the time.
"""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
from tqdm import tqdm

from impact_damper.model import packed
from impact_damper.model.bounds import check_count
from impact_damper.model.packed import FREQUENCY
from impact_damper.model.settling import Settling
from impact_damper.motions.records import MOTION, first_collisions, measure
from impact_damper.motions.settling import settle_many
from impact_damper.motions.undecided import name_undecided

# Number of motions in one call of a kernel by a thread.
CHUNK = 128


def run_chunks(work, count, workers, progress, stop, size=CHUNK):
    """Call `work(slice)` for slices that cover range(count), on `workers` threads.

    Parameters
    ----------
    work : callable
    count, workers : int
        Length of the range, and number of threads.
    progress : str or None
        Title of a progress bar; None for no progress bar.
    stop : array of bool, shape (1,)
        An error or Ctrl-C sets this flag. The function then returns without waiting for the slices
        that are being computed, so `work` and its kernels must end soon after the flag is set.
    size : int
        Length of a slice.
    """
    check_count("workers", workers, most=4096)
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


def settle(
    parameters,
    states,
    settling=None,
    *,
    start=0.0,
    from_strobe=False,
    workers=1,
    progress=None,
    stop=None,
):
    """Run motions until each has settled, and measure them.

    Parameters
    ----------
    parameters : array, shape (m, packed.COUNT)
        Packed parameters of each motion.
    states : array, shape (m, 4)
        First states Z1, Z1', Z2, Z2'.
    settling : Settling, optional
    start : float
        Time T of all states. It must lie in the forcing cycle that ends at the first strobe, the
        time T = pi/(2 W).
    from_strobe : bool
        If True, the states are states at the strobe, and `start` is not used.
    workers : int
        Number of threads.
    progress : str, optional
        Title of a progress bar; by default there is no progress bar.
    stop : array of bool, shape (1,), optional
        Another thread may set this flag to end the runs. The records are then incomplete.

    Returns
    -------
    numpy.ndarray of records.MOTION, shape (m,)

    Raises
    ------
    ValueError
        If parameters or states do not have these shapes.
    """
    settling = settling or Settling()
    parameters = np.ascontiguousarray(parameters, float)
    states = np.ascontiguousarray(states, float)
    if states.shape[1:] != (4,) or parameters.shape != (len(states), packed.COUNT):
        raise ValueError(
            f"parameters and states: must be of shapes (m, {packed.COUNT}) and (m, 4), "
            f"{parameters.shape} and {states.shape} given"
        )
    records = np.zeros(len(states), MOTION)
    stop = np.zeros(1, bool) if stop is None else stop

    def work(part):
        if from_strobe:
            begins = 0.5 * np.pi / parameters[part, FREQUENCY]
        else:
            begins = np.full(len(records[part]), start)
        settle_many(
            parameters[part],
            states[part],
            begins,
            settling.tolerance,
            settling.patience,
            settling.limit,
            records[part],
            stop,
        )
        name_undecided(parameters[part], records[part], settling.limit, settling.further, stop)
        measure(parameters[part], settling.tolerance, settling.watched, records[part], stop)

    # This call compiles the kernels in the main thread, where Ctrl-C can interrupt the compilation.
    work(slice(0, 0))
    run_chunks(work, len(states), workers, progress, stop)
    return records


def collide(parameters, states, limit, tolerance):
    """Return the number of forcing cycles from T = 0 to each motion's first contact, shape (m,).

    The number is infinite without a contact within `limit` cycles, and 0 for a state at or beyond a
    wall. The motions run in another thread, so that Ctrl-C takes effect at once. The other
    arguments are as in `settle`.
    """
    waits, stop = np.empty(len(states)), np.zeros(1, bool)

    def work(part):
        first_collisions(parameters[part], states[part], limit, tolerance, waits[part], stop)

    work(slice(0, 0))
    run_chunks(work, len(states), 1, None, stop, size=max(len(states), 1))
    return waits
