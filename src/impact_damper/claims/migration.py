"""Claims on migration control: 12, 13, 14 and 19 (section 5, figures 13 to 16)."""

import numpy as np

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Claim, Missing, Number
from impact_damper.data.datasets import damper_of, flag, oscillator_of


def lead(case, kind, free_motion):
    """Shares of the releases of each damped motion of a kind that lead to a free motion."""
    rows = case.damped_kind.values == flag("damped_kind", kind)
    return case.release_share.sel(free_motion=free_motion, bound="share").values[rows]


def only(case, kind, free_motion, choose):
    """Least or largest of `lead`, NaN if there is no such damped motion or release."""
    shares = lead(case, kind, free_motion)
    shares = shares[np.isfinite(shares)]
    return float(choose(shares)) if len(shares) else np.nan


def cases(datasets):
    """All cases of migration control, or raise Missing."""
    if not datasets.get("migration"):
        raise Missing("There is no dataset of the stage migration")
    return list(datasets["migration"].values())


def any_phase(datasets):
    """Numbers of claim 12."""
    case = extract.get(datasets, "migration", "figure_13")
    return {
        "quiet": only(case, "quiet", "non_resonance", min),
        "unsettled": only(case, "unsettled", "non_resonance", min),
        "unsettled_subharmonic": only(case, "unsettled", "subharmonic", max),
        "unsettled_resonance": only(case, "unsettled", "resonance", max),
    }


def both_outcomes(case, kind):
    """Whether releases of a damped motion lead to either of the free motions."""
    goal, other = (lead(case, kind, name) for name in ("non_resonance", "subharmonic"))
    return bool(np.any((goal > 0) & (other > 0)))


def scanned(datasets, case):
    """Releases at each frequency of the scans of a case's oscillator and damper, in order."""
    wanted = oscillator_of(case), damper_of(case)
    found = [
        scan.isel(frequency=k)
        for scan in datasets.get("release_scan", {}).values()
        if (oscillator_of(scan), damper_of(scan)) == wanted
        for k in range(scan.sizes["frequency"])
    ]
    return sorted(found, key=lambda here: float(here.frequency))


def nearest_range(scan, kind, frequency):
    """The part of a scan nearest to a frequency in which each release may lead to either motion."""
    both = np.array([both_outcomes(here, kind) for here in scan], int)
    edges = np.flatnonzero(np.diff(both, prepend=0, append=0))
    parts = [scan[first:last] for first, last in edges.reshape(-1, 2)]
    return min(
        parts,
        key=lambda part: min(abs(float(here.frequency) - frequency) for here in part),
        default=[],
    )


def release_phase(datasets):
    """Numbers of claim 13."""
    case = extract.get(datasets, "migration", "figure_15")
    frequency = extract.parameter(case, "frequency")
    lower, upper = exact.subharmonic_range(exact.free_of(datasets, case))
    scan = scanned(datasets, case)
    near = nearest_range(scan, "quiet", frequency)
    there = [here for here in scan if both_outcomes(here, "unsettled")]
    numbers = {
        "frequency": frequency,
        "lower": lower,
        "upper": upper,
        "inside": min(frequency - lower, upper - frequency),
        "quiet_there": max(
            (only(here, "quiet", "non_resonance", max) for here in near), default=np.nan
        ),
    }
    for kind, found in (("quiet", near), ("unsettled", there)):
        numbers[f"{kind}_first"] = float(found[0].frequency) if found else np.nan
        numbers[f"{kind}_last"] = float(found[-1].frequency) if found else np.nan
    for kind in ("quiet", "unsettled"):
        numbers[f"{kind}_goal"] = only(case, kind, "non_resonance", max)
        numbers[f"{kind}_subharmonic"] = only(case, kind, "subharmonic", max)
        numbers[f"{kind}_resonance"] = only(case, kind, "resonance", max)
    return numbers


def total_cycles(datasets):
    """Numbers of claim 14: all runs of all cases."""
    runs = cases(datasets)
    within = [float(run.within_share.sel(bound="share")) for run in runs]
    reached = [run.trial_outcome == flag("trial_outcome", "reached") for run in runs]
    medians = [
        float(run.switchings.where(there).median())
        for run, there in zip(runs, reached, strict=True)
    ]
    return {
        "most": np.mean(np.array(within) >= 0.5),
        "within": min(within),
        "worst": extract.parameter(runs[int(np.argmin(within))], "frequency"),
        "never": max(1 - float(there.mean()) for there in reached),
        "switchings": max((median for median in medians if median > 0), default=np.nan),
        "median": max(float(run.total_time.median()) for run in runs),
        "longest": max(float(run.total_time.max()) for run in runs),
        "damper": max(float(run.damper_time.median()) for run in runs),
    }


def early_release(datasets):
    """Numbers of claim 19."""
    case = extract.get(datasets, "migration", "figure_16")
    counts = case.destination_count.sel(damped_motion="unsettled")
    total = float(counts.sum())
    return {
        "early": float(counts.sel(free_motion="subharmonic")) / total if total else np.nan,
        "goal": float(counts.sel(free_motion="non_resonance")) / total if total else np.nan,
        "reached": float(case.reached_share.sel(bound="share")),
        "switchings": float(case.switchings.median()),
        "cycles": float(case.total_time.median()),
    }


CLAIMS = (
    Claim(
        "12",
        "W = 1.95: released at any phase, the motion goes to the non-resonance branch.",
        "section 5 (i), figure 13",
        "Released from the steady state, taken as the quiet damped "
        "motion, at even phases; beside it the motion before it has settled.",
        (
            Number(
                "quiet",
                "share of releases of the quiet motion to the non-resonance branch",
                least=1,
                decisive=True,
            ),
            Number("unsettled", "share of releases of the unsettled motion to it", least=1),
            Number("unsettled_subharmonic", "share of those to the one-third subharmonic"),
            Number("unsettled_resonance", "share of those to the resonance branch"),
        ),
        any_phase,
    ),
    Claim(
        "13",
        "W = 1.7: the release phase decides between the period-1 and the period-3 motion.",
        "section 5 (ii), figure 14",
        "Releases of the quiet damped motion at even phases, and of "
        "the motion before it has settled; the free period-3 motion must exist at that W. "
        "Beside it the frequencies of the release scans.",
        (
            Number(
                "inside",
                "distance in W from the ends of the free one-third subharmonic, negative outside",
                least=0,
                decisive=True,
            ),
            Number("lower", "W of the fold at which the free one-third subharmonic begins"),
            Number("upper", "W of the fold at which it ends"),
            Number("frequency", "W of the case"),
            Number(
                "quiet_goal",
                "share of releases of the quiet motion to the non-resonance branch",
                least=0.01,
                most=0.99,
                decisive=True,
            ),
            Number(
                "quiet_subharmonic",
                "share of them to period 3",
                least=0.01,
                most=0.99,
                decisive=True,
            ),
            Number(
                "unsettled_goal",
                "share of releases of the unsettled motion to the non-resonance branch",
            ),
            Number("unsettled_subharmonic", "share of those to period 3"),
            Number("unsettled_resonance", "share of those back to the resonance branch"),
            Number(
                "quiet_first",
                "lowest W of the nearest range in which releases of the quiet motion lead to both",
            ),
            Number("quiet_last", "highest W of that range"),
            Number("quiet_there", "largest share of them there to the non-resonance branch"),
            Number(
                "unsettled_first",
                "lowest scanned W at which releases of the unsettled motion lead to both",
            ),
            Number("unsettled_last", "highest W of those"),
        ),
        release_phase,
    ),
    Claim(
        "14",
        "Several switchings, in total not more than 350 cycles, reach the non-resonance branch.",
        "section 5",
        "Forcing periods from the first switching on until the free "
        "motion has settled; the worst of the cases.",
        (
            Number(
                "within",
                "least share of runs that arrive within 350 cycles",
                least=0.5,
                decisive=True,
            ),
            Number("within", "least share of runs that arrive within 350 cycles", least=1),
            Number("worst", "W of that case"),
            Number("most", "share of cases in which half of the runs arrive within 350 cycles"),
            Number("never", "largest share of runs that never arrive"),
            Number("switchings", "largest median of switchings of the runs that arrive"),
            Number(
                "median",
                "largest median of the cycles of all runs, those cut at their limit included",
            ),
            Number("longest", "most cycles of a run, the limit included"),
            Number("damper", "largest median of the cycles with the damper on, of all runs"),
        ),
        total_cycles,
    ),
    Claim(
        "19",
        "W = 1.85: released before the steady state, the motion goes to the period-3 "
        "branch; several switchings then lead to period 1.",
        "section 5 (iii), figure 16",
        "Switchings with the damper held for a few cycles only.",
        (
            Number(
                "early", "share of early releases that lead to period 3", least=0.01, decisive=True
            ),
            Number("early", "share of early releases that lead to period 3", least=0.5),
            Number("goal", "share of early releases that lead to the non-resonance branch"),
            Number("reached", "share of runs that arrive in the end", least=0.5, decisive=True),
            Number("reached", "share of runs that arrive in the end", least=1),
            Number("switchings", "median of the switchings"),
            Number("cycles", "median of the cycles"),
        ),
        early_release,
    ),
)
