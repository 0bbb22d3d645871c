"""Compile every kernel that the package calls, on problems of no size, and cache it."""

import numpy as np

from impact_damper.kernel import batch, single
from impact_damper.migration import legs
from impact_damper.motions import strobe_map
from impact_damper.motions.ensemble import Settling
from impact_damper.motions.records import MOTION
from impact_damper.motions.simulate import simulate
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.rivals import fixed_step, merson, runs
from impact_damper.rivals.passages import draw_passages
from impact_damper.rivals.taylor_runs import ORDERS, taylor
from impact_damper.stages.response import collisions, frequency_response
from impact_damper.system.packed import CLEARANCE
from impact_damper.system.parameters import Damper, Oscillator, pack

OSCILLATOR = Oscillator(damping=0.215)
# With it every motion settles soon at this frequency, so that orbits are followed too.
DAMPER = Damper(mass_ratio=0.25, clearance=1.0, restitution=0.75)
FREQUENCY = 1.95


def warm_up() -> None:
    """Call each kernel once with the types that it is always called with."""
    warm_up_orbits()
    warm_up_settling()


def warm_up_orbits() -> None:
    """`warm_up` of what takes one motion after the other; what both halves need first."""
    for each in single.STEPS:
        each.compile()
    on, off = (pack(OSCILLATOR, damper, FREQUENCY) for damper in (DAMPER, None))
    strobe_map.follow(on.copy(), np.zeros(4), 1, CLEARANCE, on[CLEARANCE], 1e-3, 1e-9)
    strobe_map.flow_map(on, np.zeros(4), strobe_time(on), 1, False, 1e-9)
    path, records = np.zeros((4, 5)), np.zeros(1, MOTION)
    legs.leg(off, on, np.zeros(4), 0.0, 0.0, 0.0, 1e-9, 2, path, records)
    simulate(OSCILLATOR, DAMPER, FREQUENCY, periods=1, samples=2)
    collisions(OSCILLATOR, DAMPER, FREQUENCY, starts=1, periods=1)


def warm_up_settling() -> None:
    """`warm_up` of what takes many motions until they settle, and measures them."""
    for each in batch.STEPS:
        each.compile()
    pool, places = batch.make_pool(1), np.zeros(batch.LANES, np.int64)
    batch.enter(pool, 0, pack(OSCILLATOR, DAMPER, FREQUENCY), np.zeros(4), 0, 1e-9)
    batch.send(pool, 0, 0.0, 0.01, False)
    batch.advance_some(pool, places, places.copy())
    settling = Settling(patience=100, limit=100, watched=1)
    frequency_response(
        OSCILLATOR, DAMPER, [FREQUENCY, FREQUENCY + 0.01], starts=1, settling=settling
    )


def warm_up_rivals(orders=()) -> None:
    """The same for the methods that the package is compared with, and series of further orders.

    Code that is loaded from the cache can differ in the last digit from code that was compiled in
    the same process, which shows where a method goes through a jump: all jobs are to load it.
    """
    p = pack(OSCILLATOR, DAMPER, 2.0)
    start, begin = np.array([0.082, 0.169, 0.381, -1.088]), strobe_time(p)
    for each in (ORDERS, *map(tuple, orders)):
        taylor(p, start, begin, 1, 1e-3, each)
    runs.rigid(p, 0.75, start, begin, 1, 1e-3)
    for locate in (False, True):
        runs.runge_kutta_merson(p, start, begin, 1, 1e-3, locate)
        runs.scipy_run("DOP853", p, start, begin, 1, 1e-3, locate, 1000)
    strobes, largest = np.empty((1, 4)), np.empty(1)
    merson.run_merson(p, start, begin, 1e-3, False, strobes, largest)
    fixed_step.run_fixed(fixed_step.HEUN, p, start, begin, 100, strobes, largest)
    fixed_step.fixed_ends(fixed_step.HEUN, p, start, begin, 0.01, np.empty((1, 5)))
    draw_passages(p, 1, 2.0, 0.1, 1995)
