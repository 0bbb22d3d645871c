"""What the claims and the tables read from the datasets."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from impact_damper.claims.claim import Missing
from impact_damper.datasets import flag, parameters_of
from impact_damper.variables import VARIABLES

# Curves of the configuration: by omega_l upward, with the clearance of the caption and of (19);
# by mass ratio; all elastic ones that are simulated; the inelastic twin of BY_MASS[1].
CAPTIONS = ("figure_05a", "figure_03b", "figure_03a")
RULES = ("figure_03c_rule", "figure_03b_rule", "figure_03a_rule")
BY_MASS = ("figure_05a", "figure_05b", "figure_05c")
ELASTIC = (*BY_MASS, "figure_08")
INELASTIC = "figure_10"

SYMMETRIC = 1e-6
HALF = 0.5  # a motion is high if it exceeds this share of the free resonance branch


def get(datasets, stage, name):
    """The dataset of a stage by its name, or raise Missing."""
    try:
        return datasets[stage][name]
    except KeyError:
        raise Missing(f"There is no dataset {stage}/{name}") from None


def parameter(data, name):
    """A parameter that made a dataset."""
    return parameters_of(data)[name]


def meaning(name, value):
    """Meaning of a flag by its value, in words."""
    return next(key for key, known in VARIABLES[name].flags.items() if known == value).replace(
        "_", " "
    )


def free_of(datasets, data):
    """The free oscillator that a damper of `data` is attached to, or raise Missing."""
    wanted = [parameter(data, name) for name in ("damping", "linear_frequency")]
    for free in datasets.get("free", {}).values():
        if [parameter(free, name) for name in ("damping", "linear_frequency")] == wanted:
            return free
    raise Missing(f"There is no dataset of the stage free with h = {wanted[0]:g}")


def is_outcome(data, *meanings):
    """Where motions came to one of the outcomes."""
    return data.outcome.isin([flag("outcome", meaning) for meaning in meanings])


def touching(response):
    """Motions, settled or not, in which the loose mass touches the walls."""
    return is_outcome(response, "settled", "chaotic", "unresolved") & (response.contacts > 0)


def quiet(response):
    """The smallest settled period-1 motion with contacts at each frequency, NaN where none."""
    mask = touching(response) & is_outcome(response, "settled") & (response.period == 1)
    size = response.maximum_displacement.where(mask, np.inf)
    names = ["maximum_displacement", "contacts", "asymmetry", "phase_relative", "phase_loose"]
    return response[names].isel(motion=size.argmin("motion")).where(mask.any("motion"))


def resonance_fold(free):
    """Frequency and size at which the free resonance branch ends, or raise Missing."""
    up = free.end_direction.values == flag("end_direction", "up")
    if not up.any():
        raise Missing("The free resonance branch has no upper end")
    k = np.argmax(np.where(up, free.end_displacement.values, -np.inf))
    return float(free.end_value.values[k]), float(free.end_displacement.values[k])


def resonance(free, frequency):
    """Largest settled free motion at each frequency, NaN above the resonance branch's end."""
    end, size = resonance_fold(free)
    largest = free.maximum_displacement.where(is_outcome(free, "settled")).max("motion")
    known = largest.sel(frequency=slice(None, end)).dropna("frequency")
    between = np.interp(
        frequency, [*known.frequency.values, end], [*known.values, size], right=np.nan
    )
    return xr.DataArray(between, {"frequency": frequency.values})


def high(response, free):
    """Damped motions that exceed half of the free resonance branch."""
    limit = HALF * resonance(free, response.frequency)
    return touching(response) & (response.maximum_displacement > limit)


def chaotic_high(response, free):
    """Frequencies at which a high damped motion is chaotic."""
    return (high(response, free) & is_outcome(response, "chaotic")).any("motion").values


def spacing(data):
    """Step of an even grid of frequencies."""
    return float(data.frequency[1] - data.frequency[0])


def longest_run(mask):
    """Length of the longest run of True."""
    longest = run = 0
    for value in mask:
        run = run + 1 if value else 0
        longest = max(longest, run)
    return longest


class Band(NamedTuple):
    """A suppression band by the motions that exist: edges, and how far up the lower may lie."""

    lower: float
    upper: float
    resolution: float

    @property
    def width(self):
        """Largest width that the data allow."""
        return self.upper - self.lower

    @property
    def least_width(self):
        """Least width that the data allow."""
        return self.width - self.resolution


def simulated_band(response, free):
    """Range below the resonance branch's end without any high damped motion.

    The lower edge is where the last high motion is lost: the end of its branch if it is
    settled; a chaotic one is only known to be gone at the next frequency.
    """
    upper, size = resonance_fold(free)
    motions = high(response, free)
    frequency = response.frequency.values
    there = motions.any("motion").values
    if not there.any():
        return Band(np.nan, upper, np.nan)
    last = np.flatnonzero(there)[-1]
    ends = response.end_value.values[
        (response.end_direction.values == flag("end_direction", "up"))
        & (response.end_displacement.values > HALF * size)
        & (response.end_value.values <= upper)
    ]
    lower = max([frequency[last], *ends])
    settled = is_outcome(response, "settled") | ~motions
    certain = bool(settled.isel(frequency=last).all()) and lower > frequency[last]
    beyond = frequency[last + 1] if last + 1 < len(frequency) else upper
    return Band(lower, upper, 0.0 if certain else max(min(beyond, upper) - lower, 0.0))


def free_subharmonic(free):
    """Where free motions are the one-third subharmonic, or raise Missing.

    It is symmetric and of period 3; of several such branches it is the one found at the most
    frequencies.
    """
    third = is_outcome(free, "settled") & (free.period == 3) & (free.asymmetry < SYMMETRIC)
    if not third.any():
        raise Missing("There is no one-third subharmonic without the damper")
    branches, counts = np.unique(free.branch.values[third.values], return_counts=True)
    return third & (free.branch == branches[np.argmax(counts)])


def subharmonic_range(free):
    """First and last frequency of the free one-third subharmonic, or raise Missing."""
    third = free_subharmonic(free)
    branch = free.branch.values[third.values][0]
    ends = free.end_value.values[free.end_branch.values == branch]
    frequency = free.frequency.values[third.any("motion").values]
    return min([*ends, *frequency]), max([*ends, *frequency])


def within(data, lower, upper):
    """The part of a dataset with frequencies from lower to upper, or raise Missing if none."""
    part = data.sel(frequency=slice(lower, upper))
    if part.sizes["frequency"] == 0:
        raise Missing(f"There is no frequency from {lower:.4g} to {upper:.4g}")
    return part


def band_edges(design):
    """Lower and upper edge of the suppression band by harmonic balance, or raise Missing."""
    lower, upper = design.edge_frequency.values
    if not upper > lower:
        raise Missing("There is no suppression band by harmonic balance")
    return lower, upper


def stable_impacting(design):
    """Amplitudes a of the stable solutions of (7), NaN elsewhere."""
    keep = (design.stability == flag("stability", "stable")) & (
        design.kind == flag("kind", "impacting")
    )
    return design.amplitude.where(keep)


def quiet_balance(design):
    """Signed amplitude of the smallest stable solution of (7) at each frequency."""
    amplitude = stable_impacting(design)
    size = np.abs(amplitude).fillna(np.inf)
    return amplitude.isel(solution=size.argmin("solution"))


def free_resonance_balance(design):
    """Largest free amplitude at each frequency up to the peak, NaN above."""
    return design.free_amplitude.max("free_solution").where(
        design.frequency <= design.peak_frequency
    )


def crossing(x, y, level):
    """First x at which y passes a level, by linear interpolation, NaN if it does not."""
    side = np.sign(np.asarray(y) - level)
    changes = np.flatnonzero(side[:-1] * side[1:] < 0)
    if len(changes) == 0:
        return np.nan
    k = changes[0]
    return float(x[k] + (level - y[k]) * (x[k + 1] - x[k]) / (y[k + 1] - y[k]))


def select(datasets, stage, names):
    """Several datasets of a stage, or raise Missing."""
    return [get(datasets, stage, name) for name in names]
