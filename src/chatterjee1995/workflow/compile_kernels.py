"""Compile and cache every kernel (numba function) of the package, by calls with hardly any work.

Some kernels are compiled when their module is imported. Each function below therefore imports the
modules whose kernels it calls, so that two processes can share the compilation.
"""

import gc
import json
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

from chatterjee1995.workflow.job import end_with_parent
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator

OSCILLATOR = Oscillator(damping=0.215)
# Motions with this damper settle soon at this frequency. Settled motions are followed by Newton's
# method, so that its kernels are called, and compiled, too.
DAMPER = Damper(mass_ratio=0.25, clearance=1.0, restitution=0.75)
FREQUENCY = 1.95


def compile_all(processes, orders) -> None:
    """Compile and cache all kernels, on up to two cores.

    Parameters
    ----------
    processes : int
        Number of processes.
    orders : list of list of int
        Orders of the Taylor series in flight and in contact, in addition to the package's own pair:
        the stage `accuracy` compares them.
    """
    # Compilation makes little garbage, and collecting garbage takes a fifth of its time. Forked
    # processes inherit this setting.
    gc.disable()
    fork = get_context("fork")
    with ProcessPoolExecutor(processes, fork, initializer=end_with_parent) as pool:
        for half in [pool.submit(warm_up_orbits), pool.submit(warm_up_settling)]:
            half.result()
        # This task starts last, because it needs kernels that the other two tasks compile.
        pool.submit(warm_up_rivals, orders).result()


def warm_up_orbits() -> None:
    """Call each kernel that processes one motion at a time.

    The kernels that `warm_up_settling` also calls come first, and the kernels that call kernels of
    `warm_up_settling` come last, so that the two processes rarely compile the same kernel.
    """
    from impact_damper.motions import ensemble, records, strobe_map, traces

    on, off = (pack(OSCILLATOR, damper, FREQUENCY) for damper in (DAMPER, None))
    strobe_map.polish(on, np.zeros(4), 1, 1e-3, 1e-9)
    strobe_map.repeats_sooner(on, np.zeros(4), 1, 1e-9)
    strobe_map.flow_map(on, np.zeros(4), strobe_map.strobe_time(on), 1, False, 1e-9)
    states, log = np.zeros((1, 4)), np.empty((0, 5))
    traces.trace(on, np.zeros(4), 0.0, np.zeros(1), 1e-9, states, log)
    ensemble.collide(on[None], states, 1, 1e-9)
    records.envelope(on[None], np.zeros(1), np.zeros(4), 1e-9)

    from impact_damper.orbits.paths import follow_path

    follow_path(on, np.zeros(4), 0.0, 0.01)

    from impact_damper.orbits import segments
    from impact_damper.orbits.continuation import Problem
    from impact_damper.orbits.shooting import orbit_of

    chain = segments.chain_of(on, np.array([0.0, 0.01, 0.02]), np.zeros((2, 4)), 1)
    segments.multipliers(chain.factors)
    chain.turns()
    orbit = orbit_of(chain, 1)
    problem = Problem.of(lambda value: np.append(value, on[1:]), orbit, symmetric=False)
    problem.correct(np.append(orbit.state, on[0]), np.eye(5)[-1])

    from impact_damper.motions import following, legs

    following.extrapolate(np.zeros(4), np.zeros(4), 1.0)
    path, out = np.zeros((4, 5)), np.zeros(1, records.MOTION)
    legs.leg(off, on, np.zeros(4), 0.0, 0.0, 0.0, 1e-9, 2, path, out)


def warm_up_settling() -> None:
    """Call each kernel that runs many motions until they settle."""
    from impact_damper.kernel import batch

    pool, places = batch.make_pool(1), np.zeros(batch.LANES, np.int64)
    batch.enter(pool, 0, pack(OSCILLATOR, DAMPER, FREQUENCY), np.zeros(4), 0, 1e-9)
    batch.send(pool, 0, 0.0, 0.01, False)
    batch.advance_some(pool, places, places.copy())

    from impact_damper.motions import undecided

    p, tangent, stop = pack(OSCILLATOR, DAMPER, FREQUENCY), np.ones((1, 4)), np.zeros(1, bool)
    undecided.run_block(p, np.zeros(4), tangent, np.empty((1, 4)), np.empty(1), stop)

    from chatterjee1995.stages.release_policies import release_policies
    from impact_damper.model.settling import Settling
    from impact_damper.motions.response import frequency_response
    from impact_damper.orbits.basins import basins

    settling = Settling(patience=100, limit=100, watched=1)
    basins(OSCILLATOR, None, FREQUENCY, cells=2, settling=settling)
    numbers = {"trials": 1, "tested": 1, "cells": 4, "settling": settling}
    release_policies(OSCILLATOR, [DAMPER], [FREQUENCY], **numbers)
    frequency_response(
        OSCILLATOR, DAMPER, [FREQUENCY, FREQUENCY + 0.01], starts=1, settling=settling
    )


def warm_up_rivals(orders=()) -> None:
    """Compile the kernels of all integrators that are compared, by a short run for each stage.

    A kernel loaded from the cache can give results that differ in the last digit from the results
    of a kernel compiled in the same process. A method that integrates through a jump of the force
    amplifies this difference. All kernels are therefore compiled here, so that every job loads
    them.

    Parameters
    ----------
    orders : list of list of int
        As for `compile_all`.
    """
    from chatterjee1995.methods.integrators import integrators
    from chatterjee1995.methods.integrators.taylor import ORDERS, taylor
    from chatterjee1995.methods.orbit_models import rigid
    from chatterjee1995.methods.passages import draw_passages, without_walls
    from impact_damper.motions.strobe_map import strobe_time

    p = pack(OSCILLATOR, DAMPER, 2.0)
    start, begin = np.array([0.082, 0.169, 0.381, -1.088]), strobe_time(p)
    for each in (ORDERS, *map(tuple, orders)):
        taylor(p, start, begin, 1, 1e-3, each)
    rigid(p, 0.75, start, begin, 1, 1e-3)
    for each in integrators("accuracy").values():
        for locate in each.located:
            each.run(p, start, begin, 1, 1e-3, locate, 1000)
    for each in integrators("missed_contacts").values():
        each.flight(without_walls(p), start, 1.0, 100 if each.fixed else 1e-3, 0.5)
    for each in integrators("stable_steps").values():
        each.largest_displacements(p, start, begin, 1, 100)
    draw_passages(p, 1, 2.0, 0.1, 1995)


if __name__ == "__main__":
    compile_all(*json.loads(sys.argv[1]))
