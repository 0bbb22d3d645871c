"""Changes of the invented datasets of `made_up.world`. Each change makes a claim fail."""

import json

from impact_damper.data.datasets import parameters_of


def edit(stage, name, new):
    """Return the change that replaces a dataset by `new(dataset)`."""
    return lambda data: data[stage].update({name: new(data[stage][name])})


def scale(stage, name, **factors):
    """Return the change that multiplies variables of a dataset by factors."""
    return edit(
        stage, name, lambda old: old.assign({key: old[key] * by for key, by in factors.items()})
    )


def assign(stage, name, **values):
    """Return the change that sets variables of a dataset to constant values."""
    return edit(
        stage,
        name,
        lambda old: old.assign({key: old[key].where(False, to) for key, to in values.items()}),
    )


def put(stage, name, dataset):
    """Return the change that replaces the dataset of a stage and a name by `dataset`."""
    return edit(stage, name, lambda _: dataset)


def renamed(stage, name, **values):
    """Return the change that sets parameters in the attribute of a dataset."""
    return edit(
        stage,
        name,
        lambda old: old.assign_attrs(parameters=json.dumps(parameters_of(old) | values)),
    )


def each(names, change):
    """Return the change that applies `change(name)` for several names of datasets."""
    return lambda data: [change(name)(data) for name in names]


def unstable(name, lower, upper):
    """Return the change that makes all orbits between two frequencies over Wp unstable."""

    def change(data):
        old = data["branches"][name]
        ratio = old.followed_value / float(data["harmonic_balance"][name].peak_frequency)
        kept = (ratio < lower) | (ratio > upper)
        multipliers = old.orbit_multiplier_real.where(kept, 2.0)
        data["branches"][name] = old.assign(orbit_multiplier_real=multipliers)

    return change


def share(name, kind, subharmonic):
    """Return the change that sets the share of releases to the subharmonic to `subharmonic`."""

    def new(old):
        case = old.copy(deep=True)
        row = {"damped": ["unsettled", "quiet"].index(kind)}
        case.release_share.loc[row | {"free_motion": "subharmonic"}] = subharmonic
        case.release_share.loc[row | {"free_motion": "non_resonance"}] = 1 - subharmonic
        return case

    return edit("migration", name, new)


def _power(old):
    clearance = parameters_of(old)["clearance"]
    depth = old.relative_amplitude - clearance
    return old.assign(relative_amplitude=clearance + depth ** (1 / 3) / 100)


# The penetration follows the expansion of equation (6e) as printed.
power = edit("harmonic_balance", "figure_05a", _power)
