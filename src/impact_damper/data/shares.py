"""Binomial shares, survival curves and escape rates with 95 % confidence intervals."""

import math

import numpy as np
from scipy.special import gammaincinv, ndtri  # `scipy.stats` takes half a second to import

from impact_damper.model.bounds import LEAD

# Labels of the numbers that `wilson` and `escape_rate` return.
BOUNDS = ["share", "lower", "upper"]
# Quantile of the normal distribution of a two-sided 95 % interval.
QUANTILE = 1.959963984540054


def wilson(successes, total):
    """Return a share and both ends of its Wilson 95 % interval, shape (3,); NaN if total is 0."""
    if total == 0:
        return np.full(3, np.nan)
    share, z = successes / total, ndtri(0.975)
    scale = 2 * (total + z**2)
    centre = (2 * total * share + z**2) / scale
    half = z / scale * np.sqrt(4 * total * share * (1 - share) + z**2)
    lower = centre - half if successes > 0 else 0.0
    upper = centre + half if successes < total else 1.0
    return np.array([share, lower, upper])


def wilson_intervals(successes, total):
    """Return the ends of Wilson's 95 % intervals of k successes in n trials, shape (..., 2).

    With q = QUANTILE they are [k + q^2/2 -+ q sqrt(k (n - k)/n + q^2/4)]/(n + q^2).

    Parameters
    ----------
    successes, total : array
        k and n > 0; broadcast together.
    """
    k, n = np.broadcast_arrays(np.asarray(successes, float), total)
    middle, square = k + QUANTILE**2 / 2, QUANTILE**2
    half = QUANTILE * np.sqrt(k * (n - k) / n + square / 4)
    lower = np.where(k == 0, 0.0, (middle - half) / (n + square))
    upper = np.where(k == n, 1.0, (middle + half) / (n + square))
    return np.stack([lower, upper], axis=-1)


def starts_needed(share) -> int:
    """Return the least number of trials that, if all succeed, prove a share at 95 % confidence.

    The lower end of Wilson's 95 % interval of n successes in n trials is n/(n + QUANTILE^2).
    """
    return math.ceil(share / (1 - share) * QUANTILE**2)


def failures_allowed(share, total) -> int:
    """Return the largest number of failures in `total` trials that still proves a share.

    With this number of failures the lower end of Wilson's 95 % interval is at least the share.

    Return -1 if `total` trials are too few even without a failure.
    """
    lower = wilson_intervals(np.arange(total, -1, -1), total)[:, 0]
    return int(np.sum(lower >= share)) - 1


def survival(lives, horizon, times):
    """Return the shares of runs whose lifetime exceeds each of `times`, with 95 % intervals.

    Lifetimes are known up to the horizon, the time at which all remaining runs are cut off. Since
    no run is cut off earlier, the Kaplan-Meier estimate is the binomial share.

    Parameters
    ----------
    lives : array, shape (runs,)
        Lifetimes; any value above the horizon for runs cut off.
    horizon : float
        In the unit of `lives`.
    times : array, shape (n,)

    Returns
    -------
    numpy.ndarray, shape (n, 3)
        Share, lower and upper end of its interval.

    Raises
    ------
    ValueError
        If a time exceeds the horizon.
    """
    if np.max(times) > horizon:
        raise ValueError(f"times: must be at most the horizon {horizon}, {np.max(times)} given")
    return np.array([wilson(np.sum(lives > time), len(lives)) for time in times])


def escape_rate(lives, horizon, lead=LEAD):
    """Return the rate at which runs end after the time `lead`, with its 95 % interval.

    The rate is the number of runs that end between `lead` and the horizon, divided by the sum of
    the times that all runs last between these two (time at risk). This is the estimate for
    exponentially distributed lifetimes. The interval is the chi-squared interval of a Poisson
    count.

    Returns
    -------
    numpy.ndarray, shape (3,)
        Rate, lower and upper end of its interval; NaN without time at risk.
    """
    captures = np.sum((lives > lead) & (lives <= horizon))
    exposure = np.sum(np.clip(np.minimum(lives, horizon) - lead, 0, None))
    if exposure == 0:
        return np.full(3, np.nan)
    # Quantiles of the gamma distribution, which are half of the chi-squared quantiles.
    lower = gammaincinv(captures, 0.025) if captures else 0.0
    return np.array([captures, lower, gammaincinv(captures + 1, 0.975)]) / exposure


def missed_share(data):
    """Return the share of completed runs in which an integrator finds no contact near grazing.

    In such a run the computed motion passes the wall and returns within one step, or does not reach
    the wall because of its error. The share is NaN where no run was completed.

    Parameters
    ----------
    data : xarray.Dataset
        Returned by `stages.missed_contacts.missed_contacts`, with all integrators or one.

    Returns
    -------
    xarray.DataArray
    """
    failed = data["passage_count"].sel(contact_outcome="failed")
    found = data["passage_count"].sel(contact_outcome="found")
    ended = data["passages"] - failed
    return 1 - found / ended.where(ended > 0)
