"""The steady motion that a state leads to, and one period of this motion.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass, W the
forcing frequency, and T the time.
"""

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.model.arguments import read_forced, read_start, read_state
from impact_damper.model.names import names_arguments
from impact_damper.model.settling import check_settling
from impact_damper.motions import ensemble
from impact_damper.motions.records import tabulate
from impact_damper.motions.simulate import COMPONENTS, simulate
from impact_damper.motions.strobe_map import STROBE


@names_arguments
def steady_motion(
    system, damper, frequency, state=(0.0, 0.0, 0.0, 0.0), *, start=None, settling=None
):
    """Return the steady motion that a state leads to.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
    frequency : float
        Forcing frequency W, or Hz for a machine.
    state : sequence of 4 floats, or 2 without a damper; or xarray.DataArray
        Z1, Z1', Z2, Z2' at time `start`, or a state of a dataset, which has its phase as a
        coordinate.
    start : float, optional
        Time of the state, dimensionless. The default is the time of the phase of the state, or 0 if
        the state has no phase.
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        Scalars: outcome (see `decode`), period (in forcing cycles), contacts per forcing cycle,
        largest |Z1|, asymmetry (0 if the motion is its own mirror image half a period later),
        phases of the first harmonic, largest Floquet multiplier, Lyapunov exponent, and the two
        frequencies of a quasi-periodic motion. Also `state`, a state of the motion at W T = pi/2.
        The state has this phase as a coordinate, so `simulate` and this function can continue from
        it. In a sweep, pass the state on from one frequency to the next.

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
    model = read_forced(system, damper, frequency)
    p = model.pack()
    y = read_state(model, state)
    start = read_start(model, state, start)
    begin = before_strobe(start, model.frequency)
    record = ensemble.settle(p[None], y[None], settling, start=begin)[0]
    data = {name: ((), value) for name, value in tabulate(record).items()}
    data["state"] = (("component",), record["state"])
    data |= {"state_phase": STROBE}
    parameters = model.describe(settling) | {
        "state": y.tolist(),
        "start": start,
    }
    coordinates = {"component": list(COMPONENTS), "frequency": ((), model.frequency)}
    return dataset(data, coordinates, parameters, "Steady motion of the oscillator", model)


def before_strobe(start, frequency) -> float:
    """Return a time shifted by whole forcing cycles into the cycle that ends at W T = pi/2."""
    strobe, period = STROBE / frequency, 2 * np.pi / frequency
    moved = start - np.ceil((start - strobe) / period - 1e-9) * period
    return min(moved, strobe)


def steady_orbit(system, damper, frequency, state, *, samples=200, settling=None):
    """Return samples of one period of the steady motion that a state leads to.

    Parameters
    ----------
    system, damper, frequency, state, settling
        As in `steady_motion`.
    samples : int
        Samples in a forcing cycle.

    Returns
    -------
    xarray.Dataset
        The dataset of `simulate`, from W T = pi/2 on.

    Raises
    ------
    ArithmeticError
        If the motion does not settle, escapes, or comes to rest.
    """
    settling = check_settling(settling)
    steady = steady_motion(system, damper, frequency, state, settling=settling)
    for name in ("escaped", "at_rest", "drifting", "quasi_periodic"):
        if steady["outcome"] == flag("outcome", name):
            raise ArithmeticError(f"{name}: the state leads to no periodic orbit; use simulate")
    if not is_settled(steady):
        raise ArithmeticError(
            f"settling.limit = {settling.limit}: the motion has not settled within this number of "
            "forcing cycles; a larger limit lets it run longer; steady_motion returns its outcome"
        )
    return simulate(
        system,
        damper,
        frequency,
        steady["state"],
        periods=int(steady["period"]),
        samples=samples,
        tolerance=settling.tolerance,
    )
