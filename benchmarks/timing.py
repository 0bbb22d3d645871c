"""Times by a clock: methods take turns, so that what else the machine does hits all alike."""

import gc
import math
import os
import time
from contextlib import contextmanager

import numpy as np

# A shorter call is repeated until it takes as long, in seconds.
SHORTEST = 1e-3
# Blocks of such repeats in a round, of which the fastest counts: another process that takes the
# core for a while spoils some of them only.
BLOCKS = 5


@contextmanager
def one_core():
    """Keep this process on the last of its cores, where the system lets one choose."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    allowed = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(allowed)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, allowed)


def once(call, repeats=1):
    """Seconds that a call takes, as the mean of so many in a row."""
    begin = time.perf_counter()
    for _ in range(repeats):
        call()
    return (time.perf_counter() - begin) / repeats


def repeats_of(call):
    """How often a call must be made to take SHORTEST; it has been made before."""
    first = once(call)
    if first >= SHORTEST:
        return 1
    return math.ceil(SHORTEST / min(first, once(call), once(call)))


def interleaved(calls, rounds):
    """Seconds of each call in each round, in which every call has its turn.

    Parameters
    ----------
    calls : dict of callable
    rounds : int

    Returns
    -------
    dict of numpy.ndarray, shape (rounds,)
        The fastest of BLOCKS blocks, or of one where a call takes 50 times SHORTEST.
    """
    repeats = {name: repeats_of(call) for name, call in calls.items()}
    seconds = {name: np.empty(rounds) for name in calls}
    gc.collect()
    gc.disable()
    try:
        for i in range(rounds):
            for name, call in calls.items():
                first = once(call, repeats[name])
                further = BLOCKS - 1 if first * repeats[name] < 50 * SHORTEST else 0
                others = [once(call, repeats[name]) for _ in range(further)]
                seconds[name][i] = min([first, *others])
    finally:
        gc.enable()
    return seconds


def spread(values):
    """Median, lower and upper quartile."""
    lower, median, upper = np.percentile(values, [25, 50, 75])
    return median, lower, upper
