"""Run many motions on several threads, with a progress bar.

Kernels release the interpreter lock, so threads run in parallel. Each motion is computed by
itself, so results do not depend on the number of threads.
"""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
from tqdm import tqdm

from impact_damper.motions.records import MOTION, measure
from impact_damper.motions.settling import settle_many
from impact_damper.system import packed
from impact_damper.system.bounds import check_count
from impact_damper.system.packed import FREQUENCY
from impact_damper.system.settling import Settling

# Number of motions that a thread takes at once.
CHUNK = 128


def run_chunks(work, count, workers, progress, size=CHUNK, stop=None):
    """Call `work(slice)` for slices that cover range(count), on `workers` threads.

    Parameters
    ----------
    work : callable
    count, workers : int
    progress : str or None
        Title of a progress bar.
    size : int
        Length of a slice. An error or Ctrl-C waits for the slices that have been begun.
    stop : array of bool, shape (1,), optional
        Set to true by an error or Ctrl-C, for `work` to end early.
    """
    check_count("workers", workers, most=4096)
    slices = [slice(first, min(first + size, count)) for first in range(0, count, size)]
    with (
        ThreadPoolExecutor(workers) as pool,
        tqdm(total=count, desc=progress, disable=progress is None, mininterval=1.0) as bar,
    ):
        try:
            for part, _ in zip(slices, pool.map(work, slices), strict=True):
                bar.update(part.stop - part.start)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            if stop is not None:
                stop[0] = True
            raise


def settle(parameters, states, settling=None, *, from_strobe=False, workers=1, progress=None):
    """Run motions until each has settled, and measure them.

    Parameters
    ----------
    parameters : array, shape (m, packed.COUNT)
        Packed parameters of each motion.
    states : array, shape (m, 4)
        First states Z1, Z1', Z2, Z2', at T = 0 or, with `from_strobe`, at W T = pi/2.
    settling : Settling, optional
    from_strobe : bool
        Whether the states are given at W T = pi/2.
    workers : int
        Threads.
    progress : str, optional
        Title of a progress bar; none is shown without.

    Returns
    -------
    numpy.ndarray of records.MOTION, shape (m,)

    Raises
    ------
    ValueError
        If parameters or states are not of these shapes.
    """
    settling = settling or Settling()
    parameters = np.ascontiguousarray(parameters, float)
    states = np.ascontiguousarray(states, float)
    if states.shape[1:] != (4,) or parameters.shape != (len(states), packed.COUNT):
        raise ValueError(
            f"parameters and states: must be of shapes (m, {packed.COUNT}) and (m, 4), "
            f"{parameters.shape} and {states.shape} given"
        )
    found, stop = np.zeros(len(states), MOTION), np.zeros(1, bool)

    def work(part):
        if from_strobe:
            start = 0.5 * np.pi / parameters[part, FREQUENCY]
        else:
            start = np.zeros(len(found[part]))
        settle_many(
            parameters[part],
            states[part],
            start,
            settling.tolerance,
            settling.patience,
            settling.limit,
            found[part],
            stop,
        )
        measure(parameters[part], settling.tolerance, settling.watched, found[part], stop)

    # Compiles in this thread, where Ctrl-C is heard.
    work(slice(0, 0))
    run_chunks(work, len(states), workers, progress, stop=stop)
    return found
