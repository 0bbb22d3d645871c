"""Wall times of calls that take turns: other load on the computer then slows all calls alike."""

import gc
import math
import os
import time
from contextlib import contextmanager

import numpy as np

# Seconds. A shorter call is repeated; all repeats together, called a block, take about this long.
SHORTEST = 1e-3
# Blocks in a round, of which the fastest counts: another process that occupies the core for a while
# slows down only some of the blocks.
BLOCKS = 5


@contextmanager
def one_core():
    """Keep this process on the last of its cores, if the system allows that."""
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
    """Return the seconds of a call, the mean of some repeats in a row."""
    begin = time.perf_counter()
    for _ in range(repeats):
        call()
    return (time.perf_counter() - begin) / repeats


def repeats_of(call):
    """Return how often a call must be repeated to take SHORTEST; a first call came before."""
    first = once(call)
    if first >= SHORTEST:
        return 1
    return math.ceil(SHORTEST / min(first, once(call), once(call)))


def interleaved(calls, rounds):
    """Return the seconds of each call in each round, by name; in a round every call has its turn.

    The fastest of BLOCKS blocks counts. If the first block takes 50 SHORTEST, it is the only block.
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


def spread(name, values):
    """Return the columns of a table with the median, called `name`, and the quartiles."""
    lower, median, upper = np.percentile(values, [25, 50, 75])
    return {name: median, "lower_quartile": lower, "upper_quartile": upper}
