"""Simulate one motion, from a given state or a random state.

A state is Z1, Z1', Z2, Z2': the displacement Z1 of the primary mass, its displacement Z2 relative
to the loose mass, and both velocities. A state from a dataset has its forcing phase W T as a
coordinate, and a motion from this state begins at this phase.
"""

import math
import warnings

import numpy as np

from impact_damper.data.datasets import PHASES, dataset
from impact_damper.model.bounds import (
    FARTHEST,
    FASTEST,
    MOST_RADIUS,
    PERIODS_RANGE,
    RADIUS_RANGE,
    SEED_RANGE,
    check_count,
    check_number,
    shown,
)
from impact_damper.model.checks import check_numbers
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.motions import traces

# Largest number of samples of a motion, which stay in memory.
MOST_SAMPLES = 10**7
COMPONENTS = ("displacement", "velocity", "relative_displacement", "relative_velocity")


def check_state(state, damper):
    """Return a state as an array of shape (4,).

    Without a damper two numbers suffice. Then Z2 = Z1 and Z2' = Z1', as for a loose mass at rest at
    the origin.

    Raises
    ------
    TypeError, ValueError
        If the state does not consist of four numbers (or two without a damper), or if a number is
        out of range.

    Warns
    -----
    UserWarning
        If the penetration of the loose mass into a wall exceeds the clearance.
    """
    units = getattr(state, "attrs", {}).get("units", "1")
    if units != "1":
        raise ValueError(f"state = {shown(state.values)}: must be dimensionless, not in {units}")
    if hasattr(state, "coords"):
        state = np.squeeze(state.values)  # a dataset of one motion has dimensions of length 1
    values = check_numbers("state", state)
    allowed = "four finite numbers Z1, Z1', Z2, Z2'"
    if damper is None:
        allowed += ", or two without a damper"
    if damper is None and values.shape == (2,):
        values = np.concatenate([values, values])
    if values.shape != (4,):
        raise ValueError(
            f"state = {shown(state)}: must be {allowed} "
            "(the paper's figure 4 gives three; a state of this system has four)"
        )
    for i, (value, most) in enumerate(zip(values, [FARTHEST, FASTEST] * 2, strict=True)):
        check_number(f"state[{i}]", value, least=-most, most=most)
    if damper is not None and abs(values[2]) > 2 * damper.clearance:
        _warn_of_compression(values[2], damper)
    return values


def _warn_of_compression(relative, damper):
    """Warn that a contact is compressed by more than the clearance, and how fast it expands."""
    rate = math.sqrt(damper.contact_stiffness * (1 + 1 / damper.mass_ratio))
    speed = rate * (abs(relative) - damper.clearance)
    warnings.warn(
        f"state[2] with displacement = {relative:g}: the loose mass is beyond its wall, which is "
        f"at clearance = {damper.clearance:g}; the compressed contact throws the mass back with up "
        f"to speed = {speed:.3g}",
        stacklevel=4,
    )


def carried_phase(state):
    """Return the phase W T that a state of a dataset has as a coordinate, or None."""
    coordinates = getattr(state, "coords", {})
    phases = [coordinates[name].item() for name in PHASES if name in coordinates]
    return check_number("state phase", phases[0]) if phases else None


def start_of(state, start, frequency) -> float:
    """Return the time T of a state.

    It is `start` if this is given, otherwise the time of the phase that a state of a dataset has,
    otherwise 0.

    Raises
    ------
    TypeError, ValueError
        If `start` is out of range, or if its phase differs from the phase of the state.
    """
    phase = carried_phase(state)
    if start is None:
        return 0.0 if phase is None else phase / frequency
    farthest = 1e6 * 2 * np.pi / frequency
    start = check_number("start", start, least=-farthest, most=farthest)
    if phase is not None and abs(math.remainder(frequency * start - phase, 2 * np.pi)) > 1e-6:
        raise ValueError(
            f"start = {start:.9g}: must be at the phase W T = {phase:.6g} that the state carries, "
            "or be left out; state.values has no phase"
        )
    return start


def random_states(count, radius, damper, seed, *, within_gap=True):
    """Return random states, uniform in a ball around the origin.

    Parameters
    ----------
    count : int
    radius : float
        Radius of the ball, dimensionless; 2 in the paper. With `within_gap` at most 1000
        clearances.
    damper : Damper or None
        Without a damper states are drawn from a disk of (Z1, Z1'), with Z2 = Z1 and Z2' = Z1'.
    seed : int or sequence of int
    within_gap : bool
        If True, states with |Z2| beyond the clearance are drawn again. In such states the contact
        spring would store a large energy. If False, all states of the ball are used, as in the
        paper.

    Returns
    -------
    numpy.ndarray, shape (count, 4)

    Raises
    ------
    TypeError, ValueError
        If count, radius or seed is out of range.
    """
    check_count("count", count, least=0, most=10**8)
    check_number("radius", radius, **RADIUS_RANGE)
    if damper is not None and within_gap:
        most = MOST_RADIUS * damper.clearance
        check_number("radius", radius, above=0.0, most=most, why="few states lie within the gap")
    for value in np.atleast_1d(seed):
        check_count("seed", value, **SEED_RANGE)
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


def simulate(
    oscillator,
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
    oscillator : Oscillator
    damper : Damper or None
        None for a motion without the damper.
    frequency : float
        Forcing frequency W, dimensionless.
    state : sequence of 4 floats, or 2 without a damper; or xarray.DataArray
        Z1, Z1', Z2, Z2' at time `start`, or a state of a dataset, which has its phase as a
        coordinate.
    periods : float
        Length of the motion in forcing cycles.
    samples : int
        Samples in a forcing cycle.
    start : float, optional
        Time of the first state, dimensionless; the forcing is cos(W T). The default is the time of
        the phase of the state, or 0 if the state has no phase.
    tolerance : float
        Largest local error of a step of the integrator, dimensionless.

    Returns
    -------
    xarray.Dataset
        - Over `time`: the state.
        - Over `contact`: wall (1 or -1, the sign of Z2), beginning and end of each contact, and Z2'
          at the beginning and the end. An end after the last sample is NaN.
        - With a softening spring also the scalar `escape_time`. After this time the motion has
          crossed a barrier of the spring and reaches infinity in a finite time, and the state is
          NaN. Without an escape `escape_time` is NaN.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> motion = idm.simulate(oscillator, damper, 2.0, state=(1, 0.5, 0, 0), periods=30)
    >>> motion.sizes["contact"]
    59
    """
    p = pack(oscillator, damper, frequency)
    y = check_state(state, damper)
    check_number("periods", periods, above=0.0, most=PERIODS_RANGE["most"])
    most = max(2, int(min(1e6, MOST_SAMPLES / periods)))
    check_count("samples", samples, least=2, most=most, why=f"at most {MOST_SAMPLES} samples")
    check_number("tolerance", tolerance, least=1e-15, most=1e-2)
    start = start_of(state, start, float(p[FREQUENCY]))
    length = periods * 2 * np.pi / p[FREQUENCY]
    times = start + np.linspace(0.0, length, max(int(np.ceil(periods * samples)), 1) + 1)
    states = np.empty((len(times), 4))
    log = np.empty((1024, 5))
    first = y.copy()
    count = traces.trace(p, y, start, times, tolerance, states, log)
    if count > len(log):
        log = np.empty((count, 5))
        traces.trace(p, first, start, times, tolerance, states, log)
    log = log[:count]
    data = dict(zip(COMPONENTS, states.T, strict=True))
    data |= {
        "contact_wall": log[:, 0],
        "contact_begin": log[:, 1],
        "contact_end": log[:, 2],
        "approach_velocity": log[:, 3],
        "departure_velocity": log[:, 4],
    }
    if oscillator.softens:
        escaped = np.isnan(states[:, 0])
        data["escape_time"] = times[np.argmax(escaped)] if escaped.any() else np.nan
    parameters = describe(oscillator, damper) | {
        "frequency": float(frequency),
        "state": first.tolist(),
        "start": start,
        "periods": float(periods),
        "samples": int(samples),
        "tolerance": float(tolerance),
    }
    return dataset(data, {"time": times}, parameters, "Motion of the oscillator")
