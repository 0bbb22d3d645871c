"""Numbers that test claims 12 to 14 and 19, on migration. A release switches the damper off."""

import numpy as np

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.datasets import Missing
from impact_damper.data.datasets import damper_of, flag, oscillator_of
from impact_damper.data.sweeps import runs_of_true


def any_phase(datasets):
    """Return numbers that test claim 12: at W = 1.95 all releases lead to the small free motion."""
    case = reading.get(datasets, "migration", "figure_13")
    quiet, unsettled = (_release_shares(case, kind) for kind in ("quiet", "unsettled"))
    return {"quiet": min(quiet, default=np.nan), "unsettled": min(unsettled, default=np.nan)}


def _release_shares(case, kind, free_motion="non_resonance"):
    """Return an array: for each motion with the damper the share of releases to `free_motion`.

    Only motions of the kind `kind`, such as "quiet" or "unsettled", are in the array. `case` is a
    dataset of the stage `migration`, or of the stage `release_scan` at one frequency.
    """
    rows = case.damped_kind.values == flag("released_from", kind)
    shares = case.release_share.sel(free_motion=free_motion, bound="share").values[rows]
    return shares[np.isfinite(shares)]


def release_phase(datasets):
    """Return numbers that test claim 13: at W = 1.7 the phase of release selects period 1 or 3."""
    case = reading.get(datasets, "migration", "figure_15")
    frequency = reading.parameter(case, "frequency")
    lower, upper = orbits.subharmonic_range(orbits.free_of(datasets, case))
    goal, third = (_release_shares(case, "quiet", to) for to in ("non_resonance", "subharmonic"))
    first, last = _nearest_range(_scanned(datasets, case), frequency)
    return {
        "lower": lower,
        "upper": upper,
        "inside": min(frequency - lower, upper - frequency),
        "quiet_goal": max(goal, default=np.nan),
        "quiet_subharmonic": max(third, default=np.nan),
        "quiet_first": first,
        "quiet_last": last,
    }


def _scanned(datasets, case):
    """Return a dict: frequency W -> whether the phase of release decides which motion follows.

    The value is True if from one quiet motion some releases lead to the non-resonance motion and
    others to the subharmonic. Only release scans with the oscillator and damper of `case` count.
    """
    wanted = oscillator_of(case), damper_of(case)
    found = {}
    for scan in datasets.get("release_scan", {}).values():
        if (oscillator_of(scan), damper_of(scan)) == wanted:
            for frequency in scan.frequency.values:
                here = scan.sel(frequency=frequency)
                goal = _release_shares(here, "quiet")
                third = _release_shares(here, "quiet", "subharmonic")
                found[float(frequency)] = bool(np.any((goal > 0) & (third > 0)))
    return dict(sorted(found.items()))


def _nearest_range(decides, frequency):
    scanned = list(decides)
    ends = [
        (scanned[first], scanned[last - 1]) for first, last in runs_of_true(list(decides.values()))
    ]
    return min(
        ends,
        key=lambda pair: max(pair[0] - frequency, frequency - pair[1]),
        default=(np.nan, np.nan),
    )


def total_cycles(datasets):
    """Return numbers that test claim 14: migration takes at most 350 cycles."""
    if not datasets.get("migration"):
        raise Missing("There is no dataset of the stage migration")
    cases = [
        {
            "frequency": reading.parameter(run, "frequency"),
            "within": float(run.within_share.sel(bound="share")),
            "hold": by_policy(datasets, run, "hold")[0],
            "state": by_policy(datasets, run, "state")[0],
        }
        for run in datasets["migration"].values()
    ]
    cases = sorted(cases, key=lambda case: case["frequency"])
    worst = min(cases, key=lambda case: case["within"])
    return {
        "best": min(np.fmax(case["within"], case["hold"]) for case in cases),
        "within": worst["within"],
        "worst": worst["frequency"],
        "by_state": worst["state"],
        "cases": cases,
    }


def early_release(datasets):
    """Return numbers that test claim 19: at W = 1.85 an early release leads to period 3."""
    case = reading.get(datasets, "migration", "figure_16")
    counts = case.destination_count.sel(damped_motion="unsettled")
    shares = counts / counts.sum()
    third = case.destination == flag("destination", "subharmonic")
    arrived = case.trial_outcome == flag("trial_outcome", "reached")
    by_state, by_state_cycles = by_policy(datasets, case, "state")
    return {
        "early": float(shares.sel(free_motion="subharmonic")),
        "goal": float(shares.sel(free_motion="non_resonance")),
        "resonance": float(shares.sel(free_motion="resonance")),
        "later": max(_release_shares(case, "unsettled", "subharmonic"), default=np.nan),
        "by_way": float((third.any("switching") & arrived).mean()),
        "reached": float(case.reached_share.sel(bound="share")),
        "switchings": float(case.switchings.median()),
        "cycles": float(case.total_time.median()),
        "by_state": by_state,
        "by_state_cycles": by_state_cycles,
    }


def by_policy(datasets, case, policy):
    """Return the share of runs in which a release policy succeeds, and the median time to success.

    `case` is a dataset of the stage `migration`. Only runs with the same oscillator, damper
    and frequency as in `case` count. Without such runs both results are NaN. A run succeeds if it
    reaches the goal within 350 cycles. The time is in cycles, and infinite without success.
    """
    damper, frequency = damper_of(case), reading.parameter(case, "frequency")
    names = "mass_ratio", "clearance", "restitution"
    for data in datasets.get("release_policies", {}).values():
        for index in range(data.sizes["case"]):
            one = data.isel(case=index)
            same = all(float(one[f"case_{name}"]) == getattr(damper, name) for name in names)
            if same and oscillator_of(data) == oscillator_of(case) and frequency in data.frequency:
                one = one.sel(frequency=frequency, policy=policy, bound="share")
                return float(one.policy_success), float(one.policy_cycles.sel(quantile=0.5))
    return np.nan, np.nan
