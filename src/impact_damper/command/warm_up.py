"""Short calls that compile and cache every kernel (numba function) of the library.

Modules are imported inside the functions, because some of them compile kernels when imported.
"""

import numpy as np

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator

OSCILLATOR = Oscillator(damping=0.215)
DAMPER = Damper(mass_ratio=0.25, clearance=1.0, restitution=0.75)
FREQUENCY = 1.95  # Motions settle here. Newton's method then refines them, and is compiled too.


def warm_up_orbits() -> None:
    """Call each kernel that processes one motion at a time."""
    # Another process may run `warm_up_settling` at the same time. Because of the order of the calls
    # the two processes rarely compile the same kernel at once.
    from impact_damper.motions import legs, records, strobe_map, traces

    on, off = (pack(OSCILLATOR, damper, FREQUENCY) for damper in (DAMPER, None))
    strobe_map.polish(on, np.zeros(4), 1, 1e-3, 1e-9)
    strobe_map.repeats_sooner(on, np.zeros(4), 1, 1e-9)
    traces.trace(on, np.zeros(4), 0.0, np.zeros(1), 1e-9)
    records.envelope(on[None], np.zeros(1), np.zeros(4), 1e-9)

    from impact_damper.orbits import segments
    from impact_damper.orbits.continuation import Problem
    from impact_damper.orbits.grazing import turns_of
    from impact_damper.orbits.orbit import integrate

    orbit = integrate(on, 1, np.array([0.0, 0.01, 0.02]), np.zeros((2, 4)))
    segments.multipliers(orbit.factors)
    turns_of(orbit)
    problem = Problem.of(lambda value: np.append(value, on[1:]), orbit, symmetric=False)
    problem.correct(np.append(orbit.state, on[0]), np.eye(5)[-1])

    records.measure_orbits(on[None], 1e-9, np.zeros(1, records.MOTION), np.zeros(1, bool))
    legs.leg(off, on, np.zeros(4), 0.0, 0.0, 0.0, 1e-9, 2)


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

    from impact_damper.model.settling import Settling
    from impact_damper.motions.response import frequency_response
    from impact_damper.motions.steady import steady_motion
    from impact_damper.orbits.basins import basins

    settling = Settling(patience=100, limit=100, watched=1)
    basins(OSCILLATOR, None, FREQUENCY, cells=2, settling=settling)
    frequencies = [FREQUENCY, FREQUENCY + 0.01]
    frequency_response(OSCILLATOR, DAMPER, frequencies, starts=1, settling=settling)
    steady_motion(OSCILLATOR, DAMPER, FREQUENCY, settling=settling)
