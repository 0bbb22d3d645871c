"""Simulate one motion, from a given state or a random one.

A state is Z1, Z1', Z2, Z2': the displacement Z1 of the primary mass, its displacement Z2 relative
to the loose mass, and the velocities of both. A state taken from a dataset carries its phase W T as
a coordinate, and motions begin there.
"""

import math
import warnings

import numpy as np

from impact_damper.data.datasets import PHASES, dataset
from impact_damper.motions import records
from impact_damper.system.bounds import (
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
from impact_damper.system.checks import check_numbers
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.system.parameters import describe

MOST_SAMPLES = 10**7
COMPONENTS = ("displacement", "velocity", "relative_displacement", "relative_velocity")


def check_state(state, damper):
    """Return a state as an array of shape (4,), or raise.

    Without a damper the loose mass is at rest in the origin: Z2 = Z1, Z2' = Z1'.

    Raises
    ------
    TypeError, ValueError
        If the state is not four numbers, or two without a damper, or out of range.

    Warns
    -----
    UserWarning
        If the loose mass is farther beyond a wall than the clearance.
    """
    units = getattr(state, "attrs", {}).get("units", "1")
    if units != "1":
        raise ValueError(f"state = {shown(state.values)}: must be dimensionless, not in {units}")
    if hasattr(state, "coords"):
        state = np.squeeze(state.values)  # the only point of a dataset
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
    """Return the phase W T that a state of a dataset carries as a coordinate, or None."""
    coordinates = getattr(state, "coords", {})
    phases = [coordinates[name].item() for name in PHASES if name in coordinates]
    return check_number("state phase", phases[0]) if phases else None


def start_of(state, start, frequency) -> float:
    """Return the time T of a state: `start`, or the phase of a dataset's state, or 0.

    Raises
    ------
    TypeError, ValueError
        If `start` is out of range, or at another phase than the state.
    """
    phase = carried_phase(state)
    if start is None:
        return 0.0 if phase is None else phase / frequency
    farthest = 1e6 * 2 * np.pi / frequency
    start = check_number("start", start, least=-farthest, most=farthest)
    if phase is not None and abs(math.remainder(frequency * start - phase, 2 * np.pi)) > 1e-6:
        raise ValueError(
            f"start = {start:.9g}: must be at the phase W T = {phase:.6g} that the state carries, "
            "or be left out; state.values carries none"
        )
    return start


def random_states(count, radius, damper, seed, *, within_gap=True):
    """Draw states uniformly from a ball around the origin.

    Parameters
    ----------
    count : int
    radius : float
        Dimensionless; 2 in the paper. At most 1000 clearances if draws are within the gap.
    damper : Damper or None
        Without a damper states are drawn from a disk of (Z1, Z1'), with Z2 = Z1 and Z2' = Z1'.
    seed : int or sequence of int
    within_gap : bool
        Whether draws with |Z2| beyond the clearance are repeated. There the contact spring is
        loaded with a large energy. False gives the paper's ball literally.

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
        check_number("radius", radius, above=0.0, most=most, why="hardly a draw is within the gap")
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
        None: without the damper.
    frequency : float
        Forcing frequency W, dimensionless.
    state : sequence of 4 floats, or 2 without a damper; or xarray.DataArray
        Z1, Z1', Z2, Z2' at time `start`, or the state of a dataset, which carries its phase.
    periods : float
        Length in forcing periods.
    samples : int
        Samples per forcing period.
    start : float, optional
        Time of the first state, dimensionless; the forcing is cos(W T). By default that of the
        phase which the state carries, 0 if it carries none.
    tolerance : float
        Error allowed in each step of the integrator, dimensionless.

    Returns
    -------
    xarray.Dataset
        Over `time` the state. Over `contact` the contacts: wall (1 or -1, the side of Z2),
        beginning, end, and Z2' at both (NaN for an end after the last sample). With a
        softening spring also `escape_time`, from which on the state is NaN, since the motion has
        gone over a barrier of the spring and reaches infinity in a finite time; NaN if it has not.

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
    check_count("samples", samples, least=2, most=most, why=f"{MOST_SAMPLES} in all")
    check_number("tolerance", tolerance, least=1e-15, most=1e-2)
    start = start_of(state, start, float(p[FREQUENCY]))
    length = periods * 2 * np.pi / p[FREQUENCY]
    times = start + np.linspace(0.0, length, max(int(np.ceil(periods * samples)), 1) + 1)
    states = np.empty((len(times), 4))
    log = np.empty((1024, 5))
    first = y.copy()
    count = records.trace(p, y, start, times, tolerance, states, log)
    if count > len(log):
        log = np.empty((count, 5))
        records.trace(p, first, start, times, tolerance, states, log)
    log = log[:count]
    data = dict(zip(COMPONENTS, states.T, strict=True))
    data |= {
        "contact_wall": log[:, 0],
        "contact_begin": log[:, 1],
        "contact_end": log[:, 2],
        "approach_velocity": log[:, 3],
        "departure_velocity": log[:, 4],
    }
    if oscillator.cubic < 0:
        escaped = np.isnan(states[:, 0])
        data["escape_time"] = times[np.argmax(escaped)] if escaped.any() else np.nan
    made = describe(oscillator, damper) | {
        "frequency": float(frequency),
        "state": first.tolist(),
        "start": start,
        "periods": float(periods),
        "samples": int(samples),
        "tolerance": float(tolerance),
    }
    return dataset(data, {"time": times}, made, "Motion of the oscillator")
