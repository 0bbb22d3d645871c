"""Read numbers for the claims and the tables from datasets: parameters, flags, harmonic balance.

`datasets` is a dictionary keyed by stage; each value is a dictionary of datasets keyed by the name
of an entry of the configuration, such as "figure_05a". The module `exact_orbits` reads branches of
periodic orbits. A quiet orbit has period 1 and a max |Z1| of at most half that of the resonance
without the damper. The design point of a damper is the peak frequency Wp of this resonance.
Equation (7) of the paper is harmonic balance, with the amplitude a of Z1. `design` is a dataset of
the stage `harmonic_balance`, and `response` one of the stage `response`: the motions to which
random starts (initial states) lead at each frequency W.

Z1 is the displacement of the primary mass.
"""

import numpy as np

from chatterjee1995.claims.claim import Missing
from impact_damper.data.datasets import flag, has_damper, parameters_of
from impact_damper.data.variables import VARIABLES

# Names of curves in the configuration, each a frequency response of one oscillator and damper.
# CAPTIONS: dampers with the clearances that the captions of figure 3 print, in order of increasing
#     linear frequency omega_l.
# RULES: the same dampers with the clearances of rule (19) of the paper.
# BY_MASS: the dampers of figure 5, in order of increasing mass ratio rm.
# ELASTIC: all curves with elastic contact that are simulated.
# INELASTIC: the damper BY_MASS[1] with a restitution e < 1.
CAPTIONS = ("figure_05a", "figure_03b", "figure_03a")
RULES = ("figure_03c_rule", "figure_03b_rule", "figure_03a_rule")
BY_MASS = ("figure_05a", "figure_05b", "figure_05c")
ELASTIC = (*BY_MASS, "figure_08")
INELASTIC = "figure_10"


def get(datasets, stage, name):
    """Return the dataset of a stage by its name, or raise Missing."""
    try:
        return datasets[stage][name]
    except KeyError:
        raise Missing(f"There is no dataset {stage}/{name}") from None


def damped(datasets, stage) -> dict:
    """Return the datasets of a stage that have a damper, keyed by name."""
    return {name: data for name, data in datasets.get(stage, {}).items() if has_damper(data)}


def free(datasets, stage) -> dict:
    """Return the datasets of a stage without a damper, keyed by name."""
    return {name: data for name, data in datasets.get(stage, {}).items() if not has_damper(data)}


def parameter(data, name):
    """Return the value of a parameter from which a dataset was computed."""
    return parameters_of(data)[name]


def meaning(name, value):
    """Return the meaning of a value of a flag, with spaces in place of underscores.

    An example is `meaning("outcome", 1)`, which returns "settled".
    """
    return next(key for key, known in VARIABLES[name].flags.items() if known == value).replace(
        "_", " "
    )


def is_outcome(data, *meanings):
    """Return the mask of the motions with one of the given outcomes."""
    return data.outcome.isin([flag("outcome", meaning) for meaning in meanings])


def touching(response):
    """Return the mask of the motions, settled or not, in which the loose mass touches the walls."""
    steady = is_outcome(response, "settled", "quasi_periodic", "chaotic", "unresolved")
    return steady & (response.contacts > 0)


def share_of_starts(response, motions):
    """Return the share of the random starts at each frequency that lead to motions in a mask."""
    total = response.motion_starts.sum("motion")
    return (response.motion_starts.where(motions, 0).sum("motion") / total.where(total > 0)).fillna(
        0
    )


def spacing(data):
    """Return the step of an even grid of frequencies."""
    return float(data.frequency[1] - data.frequency[0])


def longest_run(mask):
    """Return the number of elements in the longest run of True."""
    longest = run = 0
    for value in mask:
        run = run + 1 if value else 0
        longest = max(longest, run)
    return longest


def within(data, lower, upper):
    """Return the part of a dataset with frequencies from lower to upper; raise Missing if empty."""
    part = data.sel(frequency=slice(lower, upper))
    if part.sizes["frequency"] == 0:
        raise Missing(f"There is no frequency from {lower:.4g} to {upper:.4g}")
    return part


def band_edges(design):
    """Return the lower and upper edge of the suppression band by harmonic balance.

    Between them (7) has only one stable solution with contact, the quiet one.

    Raises
    ------
    Missing
        If there is no band.
    """
    lower, upper = design.edge_frequency.values
    if not upper > lower:
        raise Missing("There is no suppression band by harmonic balance")
    return lower, upper


def stable_impacting(design):
    """Return the signed amplitudes a of the stable solutions of (7); NaN for other solutions."""
    keep = (design.stability == flag("stability", "stable")) & (
        design.kind == flag("kind", "impacting")
    )
    return design.amplitude.where(keep)


def quiet_balance(design):
    """Return the signed amplitude a of the smallest stable solution of (7) at each frequency."""
    amplitude = stable_impacting(design)
    size = np.abs(amplitude).fillna(np.inf)
    return amplitude.isel(solution=size.argmin("solution"))


def free_resonance_balance(design):
    """Return the largest amplitude without the damper at each frequency up to Wp; NaN above."""
    return design.free_amplitude.max("free_solution").where(
        design.frequency <= design.peak_frequency
    )


def crossing(x, y, level):
    """Return the first x at which y crosses a level, interpolated; NaN without a crossing."""
    side = np.sign(np.asarray(y) - level)
    changes = np.flatnonzero(side[:-1] * side[1:] < 0)
    if len(changes) == 0:
        return np.nan
    k = changes[0]
    return float(x[k] + (level - y[k]) * (x[k + 1] - x[k]) / (y[k + 1] - y[k]))


def select(datasets, stage, names):
    """Return several datasets of a stage by their names, or raise Missing."""
    return [get(datasets, stage, name) for name in names]


def design_point(orbit):
    """Return the exact quiet orbit at W = Wp with the damping of the oscillator, or raise Missing.

    `orbit` is a dataset of the stage `design_orbit`. It holds the quiet orbits at W = Wp for values
    of the damping from a larger one down to that of the oscillator.
    """
    if int(orbit.design_orbit_status) != flag("design_orbit_status", "found"):
        raise Missing("There is no quiet orbit at a design point: the continuation ended before")
    return orbit.isel(point=int(np.argmin(orbit.followed_value.values)))


def largest_multiplier(orbit):
    """Return the largest modulus of the Floquet multipliers of each orbit."""
    modulus = np.hypot(orbit.orbit_multiplier_real, orbit.orbit_multiplier_imaginary)
    return modulus.max("multiplier").values


def stable_from(orbit):
    """Return the damping h above which the quiet orbit is stable.

    `orbit` is a dataset of the stage `design_orbit`.
    """
    value, events = orbit.followed_value.values, orbit.event_value.values
    last = np.max(value[largest_multiplier(orbit) >= 1], initial=value.min())
    return float(
        np.min(events[events >= last], initial=value.max()) if last > value.min() else last
    )
