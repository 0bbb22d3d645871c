"""Shares of random starts, bounds on quantiles, and rates of events, with 95 % confidence."""

import math

import numpy as np
from scipy.special import bdtr, gammaincinv  # `scipy.stats` takes half a second to import

BOUNDS = ["share", "lower", "upper"]  # labels of what `wilson` and `escape_rate` return
QUANTILE = 1.959963984540054  # of the normal distribution, for a two-sided 95 % interval
DOUBT = 0.05  # probability that a bound with 95 % confidence is wrong


def wilson_intervals(successes, total):
    """Return the ends of Wilson's 95 % interval for successes/total (total > 0), shape (..., 2)."""
    k, n = np.broadcast_arrays(np.asarray(successes, float), total)
    middle, square = k + QUANTILE**2 / 2, QUANTILE**2
    half = QUANTILE * np.sqrt(k * (n - k) / n + square / 4)
    lower = np.where(k == 0, 0.0, (middle - half) / (n + square))
    upper = np.where(k == n, 1.0, (middle + half) / (n + square))
    return np.stack([lower, upper], axis=-1)


def wilson(successes, total):
    """Return successes/total and both ends of its Wilson 95 % interval, or NaN if `total` is 0."""
    if total == 0:
        return np.full(3, np.nan)
    return np.concatenate([[successes / total], wilson_intervals(successes, total)])


def bounding_rank(share, total, doubt=DOUBT) -> int:
    """Return k such that the k-th largest of `total` samples is an upper bound of a quantile.

    The quantile is the value below which the fraction `share` of the distribution lies. The bound
    holds with the confidence 1 - doubt for any distribution (S. S. Wilks, Ann. Math. Stat. 12,
    1941). If `total` is too small for a bound, k is 0.
    """
    return int(np.sum(bdtr(np.arange(total), total, 1 - share) <= doubt))


def starts_needed(share) -> int:
    """Return the least number of samples with which `bounding_rank` finds a bound for `share`."""
    return math.ceil(math.log(DOUBT) / math.log(share))


def escape_rate(lives, horizon):
    """Return the rate per cycle at which motions end, and both ends of its 95 % interval.

    Motion i ends after lives[i] cycles. Only the first `horizon` cycles of a motion are observed.
    """
    captures = np.sum(lives <= horizon)  # number of ends that are observed
    exposure = np.sum(np.minimum(lives, horizon))  # observed cycles of all motions, added up
    # The ends of a confidence interval for a Poisson count are quantiles of a gamma distribution.
    lower = gammaincinv(captures, 0.025) if captures else 0.0
    return np.array([captures, lower, gammaincinv(captures + 1, 0.975)]) / exposure
