"""Select datasets, and read parameters, flags and solutions of harmonic balance from them.

`datasets[stage][name]` is a dataset. A `design` is a dataset of the stage `harmonic_balance`.
"""

import numpy as np

from impact_damper.data.datasets import decode, flag, has_damper, named, parameters_of

# Names of curves. CAPTIONS and RULES are sorted by omega_l, BY_MASS by rm.
CAPTIONS = ("figure_05a", "figure_03b", "figure_03a")  # figure 3, printed d0; 5 (a) is 3 (c)
RULES = ("figure_03c_rule", "figure_03b_rule", "figure_03a_rule")  # CAPTIONS with d0 by rule (19)
BY_MASS = ("figure_05a", "figure_05b", "figure_05c")  # figure 5
ELASTIC = (*BY_MASS, "figure_08")  # all simulated responses with elastic contact
INELASTIC = "figure_10"  # BY_MASS[1] with e < 1
# Release policy -> words for the policy in tables and figures.
POLICIES = {
    "settled": "random phase once settled",
    "hold": "fixed number of cycles",
    "phase": "fixed phase",
    "state": "state in the goal's basin",
}


class Missing(LookupError):
    """A needed dataset does not exist, or a dataset lacks a needed number."""


def get(datasets, stage, name):
    """Return the dataset `name` of a stage, or raise Missing."""
    try:
        return datasets[stage][name]
    except KeyError:
        raise Missing(f"There is no dataset {stage}/{name}") from None


def select(datasets, stage, names):
    """Return the datasets `names` of a stage, or raise Missing."""
    return [get(datasets, stage, name) for name in names]


def damped(datasets, stage) -> dict:
    """Return a dict with the datasets of a stage that have a damper, keyed by name."""
    return {name: data for name, data in datasets.get(stage, {}).items() if has_damper(data)}


def free(datasets, stage) -> dict:
    """Return a dict with the datasets of a stage that have no damper, keyed by name."""
    return {name: data for name, data in datasets.get(stage, {}).items() if not has_damper(data)}


def parameter(data, name):
    """Return a parameter with which a dataset was computed."""
    return parameters_of(data)[name]


def parameters(data, *names):
    """Return several parameters with which a dataset was computed."""
    return tuple(parameters_of(data)[name] for name in names)


def meaning(value):
    """Return the meaning of a flag in words, such as "settled"."""
    return decode(value).item().replace("_", " ")


def is_outcome(data, *meanings):
    """Return a mask of the motions that have one of the given outcomes."""
    return data.outcome.isin([flag("outcome", meaning) for meaning in meanings])


def touching(response):
    """Return a mask of the bounded motions in which the loose mass touches a wall."""
    steady = is_outcome(response, "settled", "quasi_periodic", "chaotic", "unresolved")
    return steady & (response.contacts > 0)


def share_of_starts(response, motions):
    """Return at each W the share of random starts that lead to motions in the mask `motions`."""
    total = response.motion_starts.sum("motion")
    led = response.motion_starts.where(motions, 0).sum("motion")
    return (led / total.where(total > 0)).fillna(0)


def within(data, lower, upper):
    """Return the part of a dataset from frequency lower to upper, or raise Missing if empty."""
    part = data.sel(frequency=slice(lower, upper))
    if part.sizes["frequency"] == 0:
        raise Missing(f"There is no frequency from {lower:.4g} to {upper:.4g}")
    return part


def crossing(x, y, level):
    """Return the first x at which y, linear between the points, crosses `level`, or NaN."""
    side = np.sign(np.asarray(y) - level)
    changes = np.flatnonzero(side[:-1] * side[1:] < 0)
    if len(changes) == 0:
        return np.nan
    k = changes[0]
    return float(x[k] + (level - y[k]) * (x[k + 1] - x[k]) / (y[k + 1] - y[k]))


def band_edges(design):
    """Return the edges of the suppression band by harmonic balance, or raise Missing."""
    lower, upper = design.edge_frequency.values
    if not upper > lower:
        raise Missing("There is no suppression band by harmonic balance")
    return lower, upper


def stable_impacting(design):
    """Return the amplitudes a of the stable solutions of (7) with impacts, and NaN for others."""
    stable = design.stability == flag("stability", "stable")
    return design.amplitude.where(stable & (design.kind == flag("kind", "impacting")))


def quiet_balance(design):
    """Return the amplitude a, with its sign, of the smallest stable solution of (7) at each W."""
    amplitude = stable_impacting(design)
    return amplitude.isel(solution=np.abs(amplitude).fillna(np.inf).argmin("solution"))


def design_point(orbit):
    """Return the exact quiet orbit at the peak frequency Wp, or raise Missing."""
    if named(orbit, "design_orbit_status") != "found":
        raise Missing("There is no quiet orbit at a design point: the continuation ended before")
    return orbit.isel(point=int(np.argmin(orbit.followed_value.values)))


def largest_multiplier(orbit):
    """Return the largest modulus of the Floquet multipliers of each orbit."""
    modulus = np.hypot(orbit.orbit_multiplier_real, orbit.orbit_multiplier_imaginary)
    return modulus.max("multiplier").values
