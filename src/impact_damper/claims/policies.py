"""Shares of releases, and policies of migration, as evidence for claims 12, 13, 14 and 19."""

import numpy as np

from impact_damper.claims import extract
from impact_damper.data.datasets import damper_of, flag, oscillator_of

# An outcome counts as possible if at least this share of the releases or runs leads to it.
LEAST = 0.01

SHARES = ("state", "hold", "phase", "settled", "clairvoyant")


def release_shares(case, kind, free_motion):
    """For each damped motion of a kind, the share of its releases that lead to a free motion."""
    rows = case.damped_kind.values == flag("damped_kind", kind)
    return case.release_share.sel(free_motion=free_motion, bound="share").values[rows]


def extreme_share(case, kind, free_motion, choose):
    """Least or largest of `release_shares` (`choose`: min or max); NaN if there are none."""
    shares = release_shares(case, kind, free_motion)
    shares = shares[np.isfinite(shares)]
    return float(choose(shares)) if len(shares) else np.nan


def by_policy(datasets, case):
    """Return measures of the releases by each policy, with the damper of a case at its W.

    Keyed `by_<policy>` with the share of runs that arrive within 350 cycles; for the policy by
    state and the clairvoyant bound also the ends of the interval and the median of the cycles;
    `through` is the share of states in the basin of the goal. NaN without the policies of migration
    for this damper and frequency.
    """
    here = _found(datasets, damper_of(case), extract.parameter(case, "frequency"), case)
    numbers = {f"by_{name}": _number(here, "policy_success", policy=name) for name in SHARES}
    for name in ("state", "clairvoyant"):
        for end, bound in (("least", "lower"), ("most", "upper")):
            numbers[f"by_{name}_{end}"] = _number(here, "policy_success", bound, policy=name)
        numbers[f"by_{name}_cycles"] = _number(here, "policy_cycles", policy=name, quantile=0.5)
    return numbers | {"through": _number(here, "realised_share")}


def _found(datasets, damper, frequency, case):
    """Return the part of a dataset of policies with a damper at a frequency, or None."""
    names = "mass_ratio", "clearance", "restitution"
    for data in datasets.get("release_policies", {}).values():
        for index in range(data.sizes["case"]):
            one = data.isel(case=index)
            same = all(float(one[f"case_{name}"]) == getattr(damper, name) for name in names)
            if same and oscillator_of(data) == oscillator_of(case) and frequency in data.frequency:
                return one.sel(frequency=frequency)
    return None


def _number(here, name, bound="share", **at):
    """Return one number of a dataset; NaN without a dataset."""
    return np.nan if here is None else float(here[name].sel(bound=bound, **at))
