"""Speed of ensembles over their size, and over the number of cores that share an ensemble.

An ensemble is a set of trajectories that the kernel, the package's compiled integrator, advances
together. A scene is a test case: a motion with several starts (initial states).
"""

import os
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context

import numpy as np
import pandas as pd

from benchmarks.methods import TIMED, advance_rows
from benchmarks.timing import interleaved, spread
from impact_damper.model.packed import CLEARANCE
from impact_damper.model.parameters import Damper
from impact_damper.motions.simulate import random_states
from impact_damper.motions.steady import run_chunks

TOLERANCE = 1e-9
RADIUS = 2.0
# Trajectories that a thread takes at a time, enough to keep the thread busy for milliseconds.
SHARE = 512
# Longest time in seconds until a process is ready.
PATIENCE = 300


def starts_of(scene, count):
    """Return starts near the scene's orbit, and random starts in a ball, whose motions differ."""
    near = np.resize(scene.starts, (count, 4))
    damper = Damper(0.12, scene.parameters[CLEARANCE]) if scene.components == 4 else None
    return {"near the orbit": near, "random": random_states(count, RADIUS, damper, 1995)}


def sizes(scenes, counts, rounds):
    """Return microseconds per trajectory and forcing cycle over the size of an ensemble."""
    rows = []
    for scene in scenes:
        run = TIMED["kernel_ensemble"].prepare(scene, TOLERANCE)
        for name, starts in starts_of(scene, max(counts)).items():
            calls = {count: partial(run, starts[:count]) for count in counts}
            for count, seconds in interleaved(calls, rounds).items():
                row = {"scene": scene.name, "starts": name, "trajectories": count}
                rows.append(row | spread("median_us", 1e6 * seconds / (count * scene.periods)))
    return pd.DataFrame(rows)


def advance_in_shares(scene, starts, workers):
    """Return states at the end, computed by threads that take SHARE trajectories at a time."""
    states = starts.copy()

    def work(part):
        advance_rows(scene, states[part], TOLERANCE)

    run_chunks(work, len(starts), workers, None, np.zeros(1, bool), SHARE)
    return states


def cores(scenes, count, rounds):
    """Return the speed-up by several threads, and whether they give the results of one thread.

    The speed-up is the throughput divided by the throughput of one thread. The starts are random.
    For comparison the table also has the speed-up by several processes that share nothing, each
    with all starts. The speed-up by processes is the largest that the computer allows.
    """
    threads = range(1, min(os.cpu_count(), 8) + 1)
    rows = []
    for scene in scenes:
        starts = starts_of(scene, count)["random"]
        calls = {("threads", n): partial(advance_in_shares, scene, starts, n) for n in threads}
        results = {n: calls["threads", n]() for n in threads}
        with processes_apart(threads[-1], scene, starts) as advance_apart:
            calls |= {("apart", n): partial(advance_apart, n) for n in threads}
            seconds = interleaved(calls, rounds)
        for n in threads:
            faster = spread("throughput", seconds["threads", 1] / seconds["threads", n])
            same = np.array_equal(results[1], results[n], equal_nan=True)
            apart = np.median(n * seconds["apart", 1] / seconds["apart", n])
            row = {"scene": scene.name, "threads": n, "trajectories": count} | faster
            rows.append(row | {"processes_apart": apart, "same_results": "yes" if same else "no"})
    return pd.DataFrame(rows)


# Scene and starts of a process of `processes_apart`; empty in any other process.
alone = {}


@contextmanager
def processes_apart(count, scene, starts):
    """Yield a function of n that lets n of `count` processes each advance all starts."""
    context = get_context("spawn")
    ready = context.Barrier(count + 1)
    with context.Pool(count, prepare, (ready, scene, starts)) as pool:
        ready.wait(PATIENCE)
        yield lambda workers: pool.map(advance_alone, range(workers), 1)


def prepare(ready, scene, starts):
    """Begin a process: keep scene and starts, load the kernels, wait for the other processes."""
    alone.update(scene=scene, starts=starts)
    advance_in_shares(scene, starts[:1], 1)
    ready.wait(PATIENCE)


def advance_alone(_):
    """Advance all starts of this process."""
    advance_in_shares(alone["scene"], alone["starts"], 1)
