"""All motions over frequency, and the share of random starts that lead to a collision."""

import numpy as np

from impact_damper.data.datasets import dataset
from impact_damper.motions import ensemble
from impact_damper.motions.simulate import COMPONENTS, random_states
from impact_damper.motions.sweep import sweep
from impact_damper.system.bounds import PERIODS_RANGE, SEED_RANGE, check_count, check_number
from impact_damper.system.checks import check_frequencies, check_starts
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.system.parameters import describe
from impact_damper.system.settling import check_settling


def frequency_response(
    oscillator,
    damper,
    frequencies,
    *,
    starts=96,
    radius=2.0,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Find all motions at each frequency, from random starts and by following (section 3).

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequencies : sequence of float
        Increasing forcing frequencies, dimensionless.
    starts : int
        Random starts at each frequency, uniform in a ball within the gap (`random_states`).
    radius : float
        Radius of that ball; 2 in the paper (section 3, iii).
    seed : int
    settling : Settling, optional
    workers : int
        Threads; the result does not depend on it.
    progress : str, optional
        Title of a progress bar.

    Returns
    -------
    xarray.Dataset
        Over (frequency, motion) the distinct motions with outcome, period, contacts, extremum of
        |Z1|, phases, multiplier, Lyapunov exponent, branch, and number of the random starts that
        lead there; over (frequency, start) outcome and length of each run; over `end` the ends
        of branches.

    Raises
    ------
    ValueError
        If frequencies are not increasing, or a parameter is out of range.
    """
    settling = check_settling(settling)
    frequencies = check_frequencies(frequencies)
    check_starts(starts, len(frequencies))
    check_count("seed", seed, **SEED_RANGE)
    parameters = np.array([pack(oscillator, damper, value) for value in frequencies])
    states = np.array(
        [random_states(starts, radius, damper, [seed, i]) for i in range(len(frequencies))]
    )
    data = sweep(
        parameters, FREQUENCY, "frequency", states, settling, workers=workers, progress=progress
    )
    made = describe(oscillator, damper, settling) | {
        "starts": starts,
        "radius": radius,
        "seed": seed,
    }
    coordinates = {"frequency": frequencies, "component": list(COMPONENTS)}
    return dataset(data, coordinates, made, "Frequency response")


def collisions(
    oscillator,
    damper,
    frequency,
    *,
    starts=2000,
    radius=2.0,
    seed=1995,
    periods=200,
    tolerance=1e-9,
):
    """Count the random starts that lead to a collision, in the literal ball and within the gap.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
        Without a damper no start collides.
    frequency : float
        Forcing frequency W, dimensionless.
    starts : int
        Starts in each ball, at T = 0.
    radius : float
        Radius of the ball; 2 in the paper (section 3, iii).
    seed : int
    periods : int
        Forcing periods within which a collision counts.
    tolerance : float
        Local error allowed.

    Returns
    -------
    xarray.Dataset
        Over `ball` (literal, within the gap): shares of starts that lie beyond a wall, that
        collide within the given forcing periods, and the longest wait for the first collision.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    p = pack(oscillator, damper, frequency)
    check_count("starts", starts, most=10**7)
    check_count("periods", periods, **PERIODS_RANGE)
    check_number("tolerance", tolerance, least=1e-15, most=1e-2)
    shares = np.empty((2, 3))
    for row, within_gap in enumerate((False, True)):
        states = random_states(starts, radius, damper, [seed, row], within_gap=within_gap)
        waits = ensemble.collide(np.tile(p, (starts, 1)), states, periods, tolerance)
        met = np.isfinite(waits)
        shares[row] = np.mean(waits == 0), np.mean(met), np.max(waits[met], initial=0.0)
    data = dict(zip(("beyond_wall", "colliding", "longest_wait"), shares.T, strict=True))
    made = describe(oscillator, damper) | {
        "frequency": float(frequency),
        "starts": starts,
        "radius": radius,
        "seed": seed,
        "periods": periods,
    }
    return dataset(data, {"ball": ["literal", "within_gap"]}, made, "First collisions")
