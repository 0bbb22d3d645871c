"""The steady motion that a state settles to, and one period of that motion."""

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.motions import ensemble
from impact_damper.motions.records import tabulate
from impact_damper.motions.simulate import COMPONENTS, check_state, simulate
from impact_damper.system.packed import pack
from impact_damper.system.parameters import describe
from impact_damper.system.settling import check_settling


def steady_motion(oscillator, damper, frequency, state=(0.0, 0.0, 0.0, 0.0), *, settling=None):
    """Return the steady motion that a state at T = 0 leads to.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        Forcing frequency W, dimensionless.
    state : sequence of 4 floats, or 2 without a damper
        Z1, Z1', Z2, Z2' at T = 0.
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        Scalars: outcome, period (in forcing periods), contacts per forcing period, largest
        |Z1|, asymmetry, phases, dominant Floquet multiplier, Lyapunov exponent; and `state`,
        a state of the motion at W T = pi/2.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    settling = check_settling(settling)
    p = pack(oscillator, damper, frequency)
    record = ensemble.settle(p[None], check_state(state, damper)[None], settling)[0]
    data = {name: ((), value) for name, value in tabulate(record).items()}
    data["state"] = (("component",), record["state"])
    made = describe(oscillator, damper, settling) | {"frequency": float(frequency)}
    return dataset(data, {"component": list(COMPONENTS)}, made, "Steady motion of the oscillator")


def steady_orbit(oscillator, damper, frequency, state, *, samples=200, settling=None):
    """Return one period, sampled, of the steady motion that a state at T = 0 settles to.

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
    for name in ("escaped", "at_rest"):
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
        steady["state"].values,
        periods=int(steady["period"]),
        samples=samples,
        start=np.pi / (2 * frequency),
        tolerance=settling.tolerance,
    )
