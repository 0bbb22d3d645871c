"""Binomial shares and escape rates with 95 % confidence intervals."""

import math

import numpy as np
from scipy.special import gammaincinv  # `scipy.stats` takes half a second to import

from impact_damper.model.bounds import LEAD

# Labels of the numbers that `wilson` and `escape_rate` return.
BOUNDS = ["share", "lower", "upper"]
# Quantile of the normal distribution of a two-sided 95 % interval.
QUANTILE = 1.959963984540054


def wilson_intervals(successes, total):
    """Return the ends of Wilson's 95 % intervals of k successes in n > 0 trials, shape (..., 2).

    With q = QUANTILE they are [k + q^2/2 -+ q sqrt(k (n - k)/n + q^2/4)]/(n + q^2).
    """
    k, n = np.broadcast_arrays(np.asarray(successes, float), total)
    middle, square = k + QUANTILE**2 / 2, QUANTILE**2
    half = QUANTILE * np.sqrt(k * (n - k) / n + square / 4)
    lower = np.where(k == 0, 0.0, (middle - half) / (n + square))
    upper = np.where(k == n, 1.0, (middle + half) / (n + square))
    return np.stack([lower, upper], axis=-1)


def wilson(successes, total):
    """Return a share and both ends of its Wilson 95 % interval, shape (3,); NaN if total is 0."""
    if total == 0:
        return np.full(3, np.nan)
    return np.concatenate([[successes / total], wilson_intervals(successes, total)])


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


def escape_rate(lives, horizon, lead=LEAD):
    """Return the rate at which runs end after the time `lead`, with its 95 % interval, shape (3,).

    The rate is the number of runs that end between `lead` and the horizon, divided by the time that
    all runs last between these two, as for exponentially distributed lives; NaN if this time is 0.
    The interval is the chi-squared interval of a Poisson count.
    """
    captures = np.sum((lives > lead) & (lives <= horizon))
    exposure = np.sum(np.clip(np.minimum(lives, horizon) - lead, 0, None))
    if exposure == 0:
        return np.full(3, np.nan)
    # Quantiles of the gamma distribution, which are half of the chi-squared quantiles.
    lower = gammaincinv(captures, 0.025) if captures else 0.0
    return np.array([captures, lower, gammaincinv(captures + 1, 0.975)]) / exposure
