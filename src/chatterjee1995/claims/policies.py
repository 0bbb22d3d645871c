"""Shares of releases, and policies of migration, as evidence for claims 12, 13, 14 and 19.

Migration leads the oscillator from its large motion (resonance) to its small one (the goal) by
switching the damper on and off. A release switches the damper off. A policy decides when to
release. A case is a dataset of one oscillator, damper and frequency. The basin of the goal is the
set of states from which a release leads to the goal.

Free means without the damper.
"""

import numpy as np

from chatterjee1995.claims import extract
from impact_damper.data.datasets import damper_of, flag, oscillator_of

# An outcome counts as possible if at least this share of the releases or runs leads to it.
LEAST = 0.01

# Policies of release (`stages.release_policies`).
SHARES = ("state", "hold", "phase", "settled")


def release_shares(case, kind, free_motion):
    """Return the share of releases that lead to a free motion, for each damped motion of a kind.

    `kind` is a value of the flag `damped_kind`, and `free_motion` a coordinate of the dataset.
    """
    rows = case.damped_kind.values == flag("damped_kind", kind)
    return case.release_share.sel(free_motion=free_motion, bound="share").values[rows]


def extreme_share(case, kind, free_motion, choose):
    """Return the least or largest of `release_shares`; NaN if there are none.

    `choose` is the function min or max.
    """
    shares = release_shares(case, kind, free_motion)
    shares = shares[np.isfinite(shares)]
    return float(choose(shares)) if len(shares) else np.nan


def by_policy(datasets, case):
    """Return measures of the releases by each policy, for the damper and frequency of a case.

    They are a dict with these entries:

    - `by_<policy>`: share of runs that arrive at the goal within 350 cycles;
    - `by_state_least`, `by_state_most`: ends of the 95 % confidence interval of `by_state`, and
      `by_state_cycles`: median number of cycles;
    - `through`: share of releases, at every phase and before the motion has settled, that lead to
      the goal.

    All are NaN if no dataset has this damper and frequency.
    """
    here = _found(datasets, damper_of(case), extract.parameter(case, "frequency"), case)
    numbers = {f"by_{name}": _number(here, "policy_success", policy=name) for name in SHARES}
    for end, bound in (("least", "lower"), ("most", "upper")):
        numbers[f"by_state_{end}"] = _number(here, "policy_success", bound, policy="state")
    numbers["by_state_cycles"] = _number(here, "policy_cycles", policy="state", quantile=0.5)
    return numbers | {"through": _number(here, "realised_share")}


def _found(datasets, damper, frequency, case):
    """Return the part of a dataset of the stage `release_policies` with a damper at a frequency.

    Its oscillator must be that of the case. Return None if there is no such dataset.
    """
    names = "mass_ratio", "clearance", "restitution"
    for data in datasets.get("release_policies", {}).values():
        for index in range(data.sizes["case"]):
            one = data.isel(case=index)
            same = all(float(one[f"case_{name}"]) == getattr(damper, name) for name in names)
            if same and oscillator_of(data) == oscillator_of(case) and frequency in data.frequency:
                return one.sel(frequency=frequency)
    return None


def _number(here, name, bound="share", **at):
    """Return one number of a dataset at given coordinates; NaN if the dataset is None."""
    return np.nan if here is None else float(here[name].sel(bound=bound, **at))
