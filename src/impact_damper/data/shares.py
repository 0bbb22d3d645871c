"""Shares, survival and escape rates with their 95 % intervals."""

import numpy as np
from scipy.stats import binomtest, chi2

BOUNDS = ["share", "lower", "upper"]
# Time units left out of a rate: runs do not begin on the motion whose life is sought.
LEAD = 20


def wilson(successes, total):
    """Share, and Wilson's 95 % interval for it; NaN of nothing."""
    if total == 0:
        return np.full(3, np.nan)
    interval = binomtest(int(successes), int(total)).proportion_ci(method="wilson")
    return np.array([successes / total, interval.low, interval.high])


def survival(lives, horizon, times):
    """Share of runs that live longer than each of the times, shape (n, 3) with its interval.

    Lives beyond the horizon count only as longer than that. No run is lost earlier, so this is
    Kaplan and Meier's estimate, and each value a binomial share.

    Raises
    ------
    ValueError
        If a time lies beyond the horizon.
    """
    if np.max(times) > horizon:
        raise ValueError(f"times: must be at most the horizon {horizon}, {np.max(times)} given")
    return np.array([wilson(np.sum(lives > time), len(lives)) for time in times])


def escape_rate(lives, horizon, lead=LEAD):
    """Rate of an exponential life beyond `lead`, with its 95 % interval, per unit of time.

    Captures over time at risk, and the chi-squared limits for a Poisson count of captures.
    """
    captures = np.sum((lives > lead) & (lives <= horizon))
    exposure = np.sum(np.clip(np.minimum(lives, horizon) - lead, 0, None))
    if exposure == 0:
        return np.full(3, np.nan)
    lower = chi2.ppf(0.025, 2 * captures) / 2 if captures else 0.0
    return np.array([captures, lower, chi2.ppf(0.975, 2 * captures + 2) / 2]) / exposure


def missed_share(data):
    """Share of the runs that came to their end which miss the contact, NaN where none did.

    Parameters
    ----------
    data : xarray.Dataset
        Of `missed_contacts.missed_contacts`, of one method or of all.

    Returns
    -------
    xarray.DataArray
    """
    failed = data["passage_count"].sel(contact_outcome="failed")
    found = data["passage_count"].sel(contact_outcome="found")
    ended = data["passages"] - failed
    return 1 - found / ended.where(ended > 0)
