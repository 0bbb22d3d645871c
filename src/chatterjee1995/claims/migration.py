"""Evidence for claims 12, 13, 14 and 19, on releases and runs of migration control.

A case is a dataset of the stage `migration`: one oscillator, damper and frequency.
"""

import numpy as np

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.datasets import Missing
from impact_damper.data.datasets import damper_of, flag, oscillator_of, parameters_of
from impact_damper.data.sweeps import runs_of_true

LEAST = 0.01  # share of releases or runs from which on an outcome counts as possible
POLICIES = ("state", "hold", "phase")


def any_phase(datasets):
    """Return the numbers of claim 12: all releases at W = 1.95 lead to the non-resonance branch."""
    case = reading.get(datasets, "migration", "figure_13")
    return {
        "releases": reading.parameter(case, "releases"),
        "quiet": _extreme_share(case, "quiet", "non_resonance", min),
        "unsettled": _extreme_share(case, "unsettled", "non_resonance", min),
        "unsettled_subharmonic": _extreme_share(case, "unsettled", "subharmonic", max),
        "unsettled_resonance": _extreme_share(case, "unsettled", "resonance", max),
    }


def _release_shares(case, kind, free_motion):
    """Return the share of releases to a free motion, for each damped motion of a kind."""
    rows = case.damped_kind.values == flag("damped_kind", kind)
    return case.release_share.sel(free_motion=free_motion, bound="share").values[rows]


def _extreme_share(case, kind, free_motion, choose):
    """Return the least or largest of these shares, as `choose` is min or max; NaN without any."""
    shares = _release_shares(case, kind, free_motion)
    shares = shares[np.isfinite(shares)]
    return float(choose(shares)) if len(shares) else np.nan


def release_phase(datasets):
    """Return the numbers of claim 13: at W = 1.7 the phase decides between period 1 and 3."""
    case = reading.get(datasets, "migration", "figure_15")
    frequency = reading.parameter(case, "frequency")
    lower, upper = orbits.subharmonic_range(orbits.free_of(datasets, case))
    scan = _scanned(datasets, case)
    quiet = _nearest_range(scan, "quiet", frequency)
    unsettled = [each for each in scan if _both_outcomes(each, "unsettled")]
    longer = [each for each in scan if _both_outcomes(each, "subharmonic", LEAST)]
    numbers = {
        "frequency": frequency,
        "lower": lower,
        "upper": upper,
        "inside": min(frequency - lower, upper - frequency),
    }
    for choose, end in ((min, "least"), (max, "most")):
        goal = [_extreme_share(each, "quiet", "non_resonance", choose) for each in quiet]
        third = [_extreme_share(each, "subharmonic", "subharmonic", choose) for each in longer]
        numbers[f"quiet_{end}"] = choose(goal, default=np.nan)
        numbers[f"longer_{end}"] = choose(third, default=np.nan)
    for kind, part in (("quiet", quiet), ("unsettled", unsettled), ("longer", longer)):
        numbers[f"{kind}_first"] = float(part[0].frequency) if part else np.nan
        numbers[f"{kind}_last"] = float(part[-1].frequency) if part else np.nan
    for kind in ("quiet", "unsettled"):
        numbers[f"{kind}_goal"] = _extreme_share(case, kind, "non_resonance", max)
        numbers[f"{kind}_subharmonic"] = _extreme_share(case, kind, "subharmonic", max)
    numbers["unsettled_resonance"] = _extreme_share(case, "unsettled", "resonance", max)
    return numbers | by_policy(datasets, case)


def _scanned(datasets, case):
    """Return the scans of releases with a case's oscillator and damper, one for each W, by W."""
    wanted = oscillator_of(case), damper_of(case)
    found = [
        scan.isel(frequency=k)
        for scan in datasets.get("release_scan", {}).values()
        if (oscillator_of(scan), damper_of(scan)) == wanted
        for k in range(scan.sizes["frequency"])
    ]
    return sorted(found, key=lambda here: float(here.frequency))


def _both_outcomes(case, kind, least=0.0):
    """Return whether a damped motion has more than `least` releases to period 3 and to the goal."""
    goal, third = (_release_shares(case, kind, name) for name in ("non_resonance", "subharmonic"))
    return bool(np.any((goal > least) & (third > least)))


def _nearest_range(scan, kind, frequency):
    """Return the neighbouring entries of a scan with both outcomes that are nearest to W."""
    runs = runs_of_true([_both_outcomes(each, kind) for each in scan])
    return min(
        (scan[first:last] for first, last in runs),
        key=lambda part: min(abs(float(each.frequency) - frequency) for each in part),
        default=[],
    )


def total_cycles(datasets):
    """Return the numbers of claim 14: runs reach the non-resonance branch within 350 cycles."""
    if not datasets.get("migration"):
        raise Missing("There is no dataset of the stage migration")
    runs = list(datasets["migration"].values())
    runs = sorted(runs, key=lambda run: reading.parameter(run, "frequency"))
    within = [float(run.within_share.sel(bound="share")) for run in runs]
    policies = [by_policy(datasets, run) for run in runs]
    holds = [each["by_hold"] for each in policies]
    worst = int(np.argmin(within))
    reached = [run.trial_outcome == flag("trial_outcome", "reached") for run in runs]
    medians = [
        float(run.switchings.where(arrived).median())
        for run, arrived in zip(runs, reached, strict=True)
    ]
    return {
        "best": min(np.fmax(within, holds)),
        "most": np.mean(np.array(within) >= 0.5),
        "within": within[worst],
        "worst": reading.parameter(runs[worst], "frequency"),
        "by_holds": holds,
        "cases": [
            {
                "frequency": reading.parameter(run, "frequency"),
                "hold": parameters_of(run).get("longest_hold"),
                "within": share,
                "runs": run.sizes["trial"],
            }
            for run, share in zip(runs, within, strict=True)
        ],
        "never": max(1 - float(arrived.mean()) for arrived in reached),
        "switchings": max((median for median in medians if median > 0), default=np.nan),
        "median": max(float(run.total_time.median()) for run in runs),
        "longest": max(float(run.total_time.max()) for run in runs),
        "damper": max(float(run.damper_time.median()) for run in runs),
    } | policies[worst]


def early_release(datasets):
    """Return the numbers of claim 19: early release at W = 1.85 leads to period 3, then to 1."""
    case = reading.get(datasets, "migration", "figure_16")
    counts = case.destination_count.sel(damped_motion="unsettled")
    total = float(counts.sum())

    def share(name):
        return float(counts.sel(free_motion=name)) / total if total else np.nan

    third = case.destination == flag("destination", "subharmonic")
    arrived = case.trial_outcome == flag("trial_outcome", "reached")
    later, later_resonance = (
        _extreme_share(case, "unsettled", name, max) for name in ("subharmonic", "resonance")
    )
    return {
        "early": share("subharmonic"),
        "goal": share("non_resonance"),
        "resonance": share("resonance"),
        "of_others": _of_others(share("subharmonic"), share("resonance")),
        "hold": parameters_of(case).get("longest_hold"),
        "later": later,
        "later_resonance": later_resonance,
        "later_of_others": _of_others(later, later_resonance),
        "by_way": float((third.any("switching") & arrived).mean()),
        "releases": int(total),
        "runs": case.sizes["trial"],
        "reached": float(case.reached_share.sel(bound="share")),
        "switchings": float(case.switchings.median()),
        "cycles": float(case.total_time.median()),
    } | by_policy(datasets, case)


def _of_others(subharmonic, resonance):
    """Return the share of the subharmonic among the releases that do not lead to resonance."""
    return subharmonic / (1 - resonance) if resonance < 1 else np.nan


def by_policy(datasets, case):
    """Return how runs with the damper and frequency of a case fare by each policy of release.

    `by_<policy>` is the share of runs that arrive at the goal within 350 cycles. For the policy
    "state" there are also the ends of the 95 % interval (`_least`, `_most`) and the median of the
    cycles. `through` is the share of releases before the motion has settled that lead to the goal.
    All are NaN if no dataset has this damper and frequency.
    """
    here = _released(datasets, case)

    def value(name, bound="share", **at):
        return np.nan if here is None else float(here[name].sel(bound=bound, **at))

    return {f"by_{name}": value("policy_success", policy=name) for name in POLICIES} | {
        "by_state_least": value("policy_success", "lower", policy="state"),
        "by_state_most": value("policy_success", "upper", policy="state"),
        "by_state_cycles": value("policy_cycles", policy="state", quantile=0.5),
        "through": value("realised_share"),
    }


def _released(datasets, case):
    """Return the part of `release_policies` with a case's oscillator, damper and W, or None."""
    damper, frequency = damper_of(case), reading.parameter(case, "frequency")
    names = "mass_ratio", "clearance", "restitution"
    for data in datasets.get("release_policies", {}).values():
        for index in range(data.sizes["case"]):
            one = data.isel(case=index)
            same = all(float(one[f"case_{name}"]) == getattr(damper, name) for name in names)
            if same and oscillator_of(data) == oscillator_of(case) and frequency in data.frequency:
                return one.sel(frequency=frequency)
    return None
