"""Functions that select datasets and read numbers from them.

`datasets[stage][name]` is a dataset. A `design` is a dataset of the stage `harmonic_balance`.
"""

import numpy as np

from impact_damper.data.datasets import decode, flag, has_damper, named, parameters_of

# Curves of figure 3 with the printed clearances, sorted by omega_l. Figure 5 (a) is figure 3 (c).
CAPTIONS = ("figure_05a", "figure_03b", "figure_03a")
# Curves of figure 3 with clearances by rule (19) in place of the printed clearances.
RULES = ("figure_03c_rule", "figure_03b_rule", "figure_03a_rule")
BY_MASS = ("figure_05a", "figure_05b", "figure_05c")  # curves of figure 5, sorted by mass ratio
ELASTIC = (*BY_MASS, "figure_08")  # all simulated responses with elastic contact
INELASTIC = "figure_10"  # BY_MASS[1] with e < 1
# Release policy -> words for this policy in tables and figures.
POLICIES = {
    "settled": "random phase once settled",
    "hold": "fixed number of cycles",
    "phase": "fixed phase",
    "state": "state in the goal's basin",
}


class Missing(LookupError):
    """A needed dataset does not exist, or a dataset lacks a needed number."""


def get(datasets, stage, name):
    """Return the dataset `name` of a stage, or raise Missing if there is none."""
    try:
        return datasets[stage][name]
    except KeyError:
        raise Missing(f"There is no dataset {stage}/{name}") from None


def select(datasets, stage, names):
    """Return a list of datasets of a stage, one for each name, or raise Missing."""
    return [get(datasets, stage, name) for name in names]


def damped(datasets, stage) -> dict:
    """Return a dict: name -> dataset of a stage, only for datasets with a damper."""
    return {name: data for name, data in datasets.get(stage, {}).items() if has_damper(data)}


def free(datasets, stage) -> dict:
    """Return a dict: name -> dataset of a stage, only for datasets without a damper."""
    return {name: data for name, data in datasets.get(stage, {}).items() if not has_damper(data)}


def parameter(data, name):
    """Return the parameter `name` with which a dataset was computed."""
    return parameters_of(data)[name]


def parameters(data, *names):
    """Return a tuple of the parameters `names` with which a dataset was computed."""
    return tuple(parameters_of(data)[name] for name in names)


def meaning(value):
    """Return in words, such as "settled", what an integer flag of a dataset means."""
    return decode(value).item().replace("_", " ")


def is_outcome(data, *meanings):
    """Return a mask of the motions whose outcome is one of `meanings`, such as "chaotic"."""
    return data.outcome.isin([flag("outcome", meaning) for meaning in meanings])


def touching(response):
    """Return a mask of the motions with contacts. Motions that diverge or escape do not count."""
    steady = is_outcome(response, "settled", "quasi_periodic", "chaotic", "unresolved")
    return steady & (response.contacts > 0)


def share_of_starts(response, motions):
    """Return at each W the share of random starts whose motion has True in the mask `motions`."""
    total = response.motion_starts.sum("motion")
    led = response.motion_starts.where(motions, 0).sum("motion")
    return (led / total.where(total > 0)).fillna(0)


def within(data, lower, upper):
    """Return the part of a dataset from W = `lower` to `upper`, or raise Missing if it is empty."""
    part = data.sel(frequency=slice(lower, upper))
    if part.sizes["frequency"] == 0:
        raise Missing(f"There is no frequency from {lower:.4g} to {upper:.4g}")
    return part


def crossing(x, y, level):
    """Return the first x at which the polyline through points (x, y) crosses a level, or NaN."""
    side = np.sign(np.asarray(y) - level)
    changes = np.flatnonzero(side[:-1] * side[1:] < 0)
    if len(changes) == 0:
        return np.nan
    k = changes[0]
    return float(x[k] + (level - y[k]) * (x[k + 1] - x[k]) / (y[k + 1] - y[k]))


def band_edges(design):
    """Return the ends of the suppression band in a harmonic balance dataset, or raise Missing."""
    lower, upper = design.edge_frequency.values
    if not upper > lower:
        raise Missing("There is no suppression band by harmonic balance")
    return lower, upper


def stable_impacting(design):
    """Return amplitudes by equation (7), NaN where a solution is not stable or has no contacts."""
    stable = design.stability == flag("stability", "stable")
    return design.amplitude.where(stable & (design.kind == flag("kind", "impacting")))


def quiet_balance(design):
    """Return at each W the amplitude a of the stable impacting solution of (7) with least |a|."""
    amplitude = stable_impacting(design)
    return amplitude.isel(solution=np.abs(amplitude).fillna(np.inf).argmin("solution"))


def design_point(orbit):
    """Return the quiet orbit at the design point from a dataset of the stage `design_orbit`."""
    if named(orbit, "design_orbit_status") != "found":
        raise Missing("There is no quiet orbit at a design point: the continuation ended before")
    return orbit.isel(point=int(np.argmin(orbit.followed_value.values)))


def largest_multiplier(orbit):
    """Return for each orbit the largest modulus of its Floquet multipliers."""
    modulus = np.hypot(orbit.orbit_multiplier_real, orbit.orbit_multiplier_imaginary)
    return modulus.max("multiplier").values
