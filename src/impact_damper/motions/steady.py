"""The steady motion that a state settles to, and one period of that motion."""

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.motions import ensemble
from impact_damper.motions.records import tabulate
from impact_damper.motions.simulate import COMPONENTS, check_state, simulate, start_of
from impact_damper.motions.strobe_map import STROBE
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.system.parameters import describe
from impact_damper.system.settling import check_settling


def steady_motion(
    oscillator, damper, frequency, state=(0.0, 0.0, 0.0, 0.0), *, start=None, settling=None
):
    """Return the steady motion that a state leads to.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        Forcing frequency W, dimensionless.
    state : sequence of 4 floats, or 2 without a damper; or xarray.DataArray
        Z1, Z1', Z2, Z2' at time `start`, or the state of a dataset, which carries its phase.
    start : float, optional
        Time of the state, dimensionless. By default that of the phase which the state carries, 0 if
        it carries none.
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        Scalars: outcome (see `decode`), period (in forcing periods), contacts per forcing period,
        largest |Z1|, asymmetry (0 if half a period later the motion is its mirror image), phases
        of its first harmonic, largest Floquet multiplier, Lyapunov exponent, the two frequencies of
        a quasi-periodic motion; and `state`, a state of the motion at W T = pi/2. The state
        carries this phase as a coordinate, so that `simulate` and this function go on from there:
        in a sweep hand it on from one frequency to the next.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper, state = idm.Oscillator(0.215), idm.Damper(0.12, 2.0), (0, 0, 0, 0)
    >>> upward = []
    >>> for frequency in (1.9, 2.0, 2.1):
    ...     steady = idm.steady_motion(oscillator, damper, frequency, state)
    ...     state = steady.state
    ...     upward.append(steady)
    """
    settling = check_settling(settling)
    p = pack(oscillator, damper, frequency)
    y = check_state(state, damper)
    start = start_of(state, start, float(p[FREQUENCY]))
    begin = before_strobe(start, float(p[FREQUENCY]))
    record = ensemble.settle(p[None], y[None], settling, start=begin)[0]
    data = {name: ((), value) for name, value in tabulate(record).items()}
    data["state"] = (("component",), record["state"])
    data |= {"state_phase": STROBE}
    made = describe(oscillator, damper, settling) | {
        "frequency": float(frequency),
        "state": y.tolist(),
        "start": start,
    }
    coordinates = {"component": list(COMPONENTS), "frequency": ((), float(frequency))}
    return dataset(data, coordinates, made, "Steady motion of the oscillator")


def before_strobe(start, frequency) -> float:
    """Return a time moved by whole forcing periods into the one that ends with the strobe."""
    strobe, period = STROBE / frequency, 2 * np.pi / frequency
    moved = start - np.ceil((start - strobe) / period - 1e-9) * period
    return min(moved, strobe)


def steady_orbit(oscillator, damper, frequency, state, *, samples=200, settling=None):
    """Return one period, sampled, of the steady motion that a state settles to.

    Parameters
    ----------
    oscillator, damper, frequency, state, settling
        As in `steady_motion`.
    samples : int
        Samples per forcing period.

    Returns
    -------
    xarray.Dataset
        As from `simulate`, from W T = pi/2 on.

    Raises
    ------
    ArithmeticError
        If the motion does not settle, escapes, or comes to rest.
    """
    settling = check_settling(settling)
    steady = steady_motion(oscillator, damper, frequency, state, settling=settling)
    for name in ("escaped", "at_rest", "drifting", "quasi_periodic"):
        if steady["outcome"] == flag("outcome", name):
            raise ArithmeticError(f"{name}: the motion leads to no orbit; simulate shows it")
    if not is_settled(steady):
        raise ArithmeticError(
            f"settling.limit = {settling.limit}: the motion has not settled by then; "
            "a larger limit lets it run on, and steady_motion tells what it came to"
        )
    return simulate(
        oscillator,
        damper,
        frequency,
        steady["state"],
        periods=int(steady["period"]),
        samples=samples,
        tolerance=settling.tolerance,
    )
