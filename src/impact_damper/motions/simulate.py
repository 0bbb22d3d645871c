"""Simulate one motion from a given state; draw random states."""

import numpy as np

from impact_damper.data.datasets import dataset
from impact_damper.kernel.equation import spring
from impact_damper.model import bounds
from impact_damper.model.arguments import read_forced, read_start, read_state
from impact_damper.model.packed import DAMPING, FREQUENCY
from impact_damper.motions import traces
from impact_damper.motions.panels import base_displacement, contact_forces, penetration, wall_force

MOST_SAMPLES = 10**7
COMPONENTS = ("displacement", "velocity", "relative_displacement", "relative_velocity")
CONTACT = "contact_wall contact_begin contact_end approach_velocity departure_velocity".split()


def random_states(count, radius, damper, seed, *, within_gap=True):
    """Return `count` states (Z1, Z1', Z2, Z2'), uniform in a ball around 0 with a given radius.

    If `within_gap`, a state with |Z2| above the clearance is drawn again, because the wall would
    store a large energy. Without a damper (Z1, Z1') is uniform in a disk, and Z2 = Z1, Z2' = Z1'.
    """
    if damper is not None and within_gap:
        limits = {"above": 0.0, "most": bounds.MOST_RADIUS * damper.clearance}
        bounds.check_number("radius", radius, **limits, why="few states lie within the gap")
    generator = np.random.default_rng(seed)
    size = 2 if damper is None else 4
    states = np.empty((0, size))
    while len(states) < count:
        direction = generator.standard_normal((count, size))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        drawn = radius * direction * generator.random((count, 1)) ** (1 / size)
        if damper is not None and within_gap:
            drawn = drawn[np.abs(drawn[:, 2]) < damper.clearance]
        states = np.concatenate([states, drawn])
    states = states[:count]
    return np.hstack([states, states]) if damper is None else states


@bounds.names_arguments
def simulate(
    system,
    damper,
    frequency,
    state=(0.0, 0.0, 0.0, 0.0),
    *,
    periods=20,
    samples=200,
    start=None,
    tolerance=1e-12,
):
    """Integrate one motion.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
        None for a motion without the damper.
    frequency : float
        Forcing frequency W, or Hz for a machine.
    state : sequence of 4 floats, or 2 without a damper; or xarray.DataArray
        Z1, Z1', Z2, Z2' at the time `start`; or the state in a dataset, stored with its phase.
    periods : float
        Length of the motion in forcing cycles.
    samples : int
        Samples in a forcing cycle.
    start : float, optional
        Time T of the first state, in s for a machine. The forcing is proportional to cos(W T). By
        default W T is the phase of the state, or 0 if the state has no phase.
    tolerance : float
        Largest local error of a step of the integrator, dimensionless.

    Returns
    -------
    xarray.Dataset
        - Over `time`: the state. On a moving base Z1 is relative to the base; the absolute
          displacement and the absolute acceleration of the primary mass are further variables.
        - Over `contact`: wall (1 or -1, the sign of Z2), beginning and end of each contact, Z2' at
          the beginning and the end, and the largest force (N for a machine, otherwise divided by
          the primary mass). If a contact ends after the last sample, its end is NaN.
        - The scalar `largest_contact_force`, 0 without contacts.
        - With a softening spring: the scalar `escape_time`, NaN without an escape. A motion escapes
          when it crosses a barrier of the spring and tends to infinity. Later states are NaN.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> motion = idm.simulate(oscillator, damper, 2.0, state=(1, 0.5, 0, 0), periods=30)
    >>> motion.sizes["contact"]
    59
    """
    model = read_forced(system, damper, frequency)
    p = model.pack()
    y = read_state(model, state)
    bounds.check_number("periods", periods, above=0.0, most=bounds.PERIODS_RANGE["most"])
    most = max(2, int(min(1e6, MOST_SAMPLES / periods)))
    why = f"at most {MOST_SAMPLES} samples"
    bounds.check_count("samples", samples, least=2, most=most, why=why)
    bounds.check_number("tolerance", tolerance, least=1e-15, most=1e-2)
    start = read_start(model, state, start)
    length = periods * 2 * np.pi / p[FREQUENCY]
    times = start + np.linspace(0.0, length, max(int(np.ceil(periods * samples)), 1) + 1)
    states, log = traces.trace(p, y, start, times, tolerance)
    data = dict(zip((*COMPONENTS, *CONTACT), (*states.T, *log.T), strict=True))
    forces = contact_forces(p, y, (start, times[-1]), (states, log), tolerance)
    data |= {"contact_force": forces, "largest_contact_force": np.max(forces, initial=0.0)}
    if model.oscillator.base:
        data |= _absolute(p, times, states, log)
    if model.oscillator.softens:
        escaped = np.isnan(states[:, 0])
        data["escape_time"] = times[np.argmax(escaped)] if escaped.any() else np.nan
    parameters = model.describe() | {"state": y.tolist(), "start": start}
    parameters |= {"periods": float(periods), "samples": int(samples)}
    parameters["tolerance"] = float(tolerance)
    return dataset(data, {"time": times}, parameters, "Motion of the oscillator", model)


def _absolute(p, times, states, log):
    x, v = states[:, 0], states[:, 1]
    walls = np.zeros(len(times))
    last = np.searchsorted(log[:, 1], times, side="right") - 1
    touching = (last >= 0) & ~(times > log[last, 2]) if len(log) else walls > 0
    walls[touching] = log[last[touching], 0]
    push = walls * wall_force(p, *penetration(p, states, walls))
    return {
        "absolute_displacement": x + base_displacement(p, times),
        "absolute_acceleration": -p[DAMPING] * v - spring.py_func(p, x) - push,
    }
