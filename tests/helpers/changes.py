"""Changes of the invented datasets of `made_up.world`, each of which makes a claim fail.

The functions return a change: a function that takes the datasets, keyed by stage and name, and
changes them. `power` is a change itself.
"""

import json

from impact_damper.data.datasets import parameters_of


def scale(stage, name, **factors):
    """Return the change that multiplies variables of a dataset by factors."""

    def change(data):
        for variable, factor in factors.items():
            data[stage][name] = data[stage][name].assign(
                {variable: data[stage][name][variable] * factor}
            )

    return change


def assign(stage, name, **values):
    """Return the change that sets variables of a dataset to constant values."""

    def change(data):
        for variable, value in values.items():
            old = data[stage][name][variable]
            data[stage][name] = data[stage][name].assign({variable: old.where(False, value)})

    return change


def each(names, change):
    """Return the change that applies `change(name)` for several names of datasets."""

    def changes(data):
        for name in names:
            change(name)(data)

    return changes


def put(stage, name, dataset):
    """Return the change that replaces the dataset `name` by a given one."""

    def change(data):
        data[stage][name] = dataset

    return change


def unstable(name, lower, upper):
    """Return the change that makes all orbits between two frequencies unstable.

    `lower` and `upper` are ratios to the peak frequency.
    """

    def change(data):
        old = data["branches"][name]
        peak = float(data["harmonic_balance"][name].peak_frequency)
        kept = (old.followed_value < lower * peak) | (old.followed_value > upper * peak)
        multipliers = old.orbit_multiplier_real.where(kept, 2.0)
        data["branches"][name] = old.assign(orbit_multiplier_real=multipliers)

    return change


def share(name, kind, subharmonic):
    """Return the change that sets where releases (switching the damper off) lead.

    `kind` is the motion before the release, "unsettled" or "quiet". `subharmonic` is the share of
    releases that lead to the subharmonic; the others lead to the non-resonance motion.
    """

    def change(data):
        case = data["migration"][name].copy(deep=True)
        row = {"damped": ["unsettled", "quiet"].index(kind)}
        case.release_share.loc[row | {"free_motion": "subharmonic"}] = subharmonic
        case.release_share.loc[row | {"free_motion": "non_resonance"}] = 1 - subharmonic
        data["migration"][name] = case

    return change


def power(data):
    """Set the penetration to the value by the expansion of equation (6e) as printed."""
    old = data["harmonic_balance"]["figure_05a"]
    clearance = parameters_of(old)["clearance"]
    depth = old.relative_amplitude - clearance
    data["harmonic_balance"]["figure_05a"] = old.assign(
        relative_amplitude=clearance + depth ** (1 / 3) / 100
    )


def renamed(stage, name, **values):
    """Return the change that sets parameters in the attribute of a dataset."""

    def change(data):
        old = data[stage][name].copy()
        old.attrs["parameters"] = json.dumps(parameters_of(old) | values)
        data[stage][name] = old

    return change
