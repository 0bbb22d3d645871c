"""Changes of the invented datasets of `made_up.world`: each takes the datasets and changes them."""

import json

from impact_damper.claims import extract
from impact_damper.data.datasets import parameters_of


def scale(stage, name, **factors):
    """A change of the made-up data: variables of a dataset times factors."""

    def change(data):
        for variable, factor in factors.items():
            data[stage][name] = data[stage][name].assign(
                {variable: data[stage][name][variable] * factor}
            )

    return change


def assign(stage, name, **values):
    """A change of the made-up data: variables of a dataset set to a value."""

    def change(data):
        for variable, value in values.items():
            old = data[stage][name][variable]
            data[stage][name] = data[stage][name].assign({variable: old.where(False, value)})

    return change


def each(names, change):
    """A change of several made-up datasets."""

    def changes(data):
        for name in names:
            change(name)(data)

    return changes


def copy(stage, name, source):
    """A change of the made-up data: one dataset in place of another."""

    def change(data):
        data[stage][name] = data[stage][source]

    return change


def put(stage, name, dataset):
    """A change of the made-up data: another dataset in place of one."""

    def change(data):
        data[stage][name] = dataset

    return change


def unstable(name, lower, upper):
    """A change of the made-up data: no stable orbit between two frequencies over the peak."""

    def change(data):
        old = data["branches"][name]
        peak = float(data["harmonic_balance"][name].peak_frequency)
        kept = (old.followed_value < lower * peak) | (old.followed_value > upper * peak)
        multipliers = old.orbit_multiplier_real.where(kept, 2.0)
        data["branches"][name] = old.assign(orbit_multiplier_real=multipliers)

    return change


def share(name, kind, subharmonic):
    """A change of the made-up data: where releases of a damped motion lead."""

    def change(data):
        case = data["migration"][name].copy(deep=True)
        row = {"damped": ["unsettled", "quiet"].index(kind)}
        case.release_share.loc[row | {"free_motion": "subharmonic"}] = subharmonic
        case.release_share.loc[row | {"free_motion": "non_resonance"}] = 1 - subharmonic
        data["migration"][name] = case

    return change


def early(subharmonic):
    """A change of the made-up data: counts of the early releases to the subharmonic."""

    def change(data):
        case = data["migration"]["figure_16"].copy(deep=True)
        case.destination_count.loc[{"damped_motion": "unsettled"}] = 0
        for motion, count in (("subharmonic", subharmonic), ("non_resonance", 10 - subharmonic)):
            case.destination_count.loc[{"damped_motion": "unsettled", "free_motion": motion}] = (
                count
            )
        data["migration"]["figure_16"] = case

    return change


def power(data):
    """A change of the made-up data: the penetration that the expansion of (6e) gives."""
    old = data["harmonic_balance"]["figure_05a"]
    clearance = extract.parameter(old, "clearance")
    depth = old.relative_amplitude - clearance
    data["harmonic_balance"]["figure_05a"] = old.assign(
        relative_amplitude=clearance + depth ** (1 / 3) / 100
    )


def fourth(data):
    """A change of the made-up data: the state's missing component."""
    old = data["motion"]["figure_04"]
    data["motion"]["figure_04"] = old.assign(relative_velocity=old.velocity)


def renamed(stage, name, **values):
    """A change of the made-up data: parameters that made a dataset."""

    def change(data):
        old = data[stage][name].copy()
        old.attrs["parameters"] = json.dumps(parameters_of(old) | values)
        data[stage][name] = old

    return change
