"""Claims 12, 13, 14 and 19, on migration control (section 5, figures 13 to 16).

Migration leads the free oscillator from the resonance to the non-resonance branch, by switching the
damper on and off again (release). A case is a dataset of one oscillator, damper and frequency.
"""

import numpy as np

from impact_damper.claims import exact_orbits, extract
from impact_damper.claims.claim import Claim, Measure, Missing
from impact_damper.claims.findings import migration as migration_findings
from impact_damper.claims.policies import by_policy
from impact_damper.data.datasets import damper_of, flag, oscillator_of


def release_shares(case, kind, free_motion):
    """For each damped motion of a kind, the share of its releases that lead to a free motion."""
    rows = case.damped_kind.values == flag("damped_kind", kind)
    return case.release_share.sel(free_motion=free_motion, bound="share").values[rows]


def extreme_share(case, kind, free_motion, choose):
    """Least or largest of `release_shares` (`choose`: min or max); NaN if there are none."""
    shares = release_shares(case, kind, free_motion)
    shares = shares[np.isfinite(shares)]
    return float(choose(shares)) if len(shares) else np.nan


def cases(datasets):
    """Return all cases of migration control, or raise Missing."""
    if not datasets.get("migration"):
        raise Missing("There is no dataset of the stage migration")
    return list(datasets["migration"].values())


def any_phase(datasets):
    """Measures of claim 12: released at any phase at W = 1.95, the non-resonance branch results."""
    case = extract.get(datasets, "migration", "figure_13")
    return {
        "quiet": extreme_share(case, "quiet", "non_resonance", min),
        "unsettled": extreme_share(case, "unsettled", "non_resonance", min),
        "unsettled_subharmonic": extreme_share(case, "unsettled", "subharmonic", max),
        "unsettled_resonance": extreme_share(case, "unsettled", "resonance", max),
    }


def both_outcomes(case, kind):
    """Whether releases of one damped motion lead to both the non-resonance branch and period 3."""
    goal, third = (release_shares(case, kind, name) for name in ("non_resonance", "subharmonic"))
    return bool(np.any((goal > 0) & (third > 0)))


def scanned(datasets, case):
    """Release scans of a case's oscillator and damper: a dataset per frequency, in rising order."""
    wanted = oscillator_of(case), damper_of(case)
    found = [
        scan.isel(frequency=k)
        for scan in datasets.get("release_scan", {}).values()
        if (oscillator_of(scan), damper_of(scan)) == wanted
        for k in range(scan.sizes["frequency"])
    ]
    return sorted(found, key=lambda here: float(here.frequency))


def nearest_range(scan, kind, frequency):
    """Part of a scan, nearest to a frequency, in which releases lead to both free motions.

    The part is a list of neighbouring entries of `scanned`; empty if there is none.
    """
    both = np.array([both_outcomes(releases, kind) for releases in scan], int)
    edges = np.flatnonzero(np.diff(both, prepend=0, append=0))
    parts = [scan[first:last] for first, last in edges.reshape(-1, 2)]
    return min(
        parts,
        key=lambda part: min(abs(float(releases.frequency) - frequency) for releases in part),
        default=[],
    )


def release_phase(datasets):
    """Measures of claim 13: at W = 1.7 the release phase decides between period 1 and period 3."""
    case = extract.get(datasets, "migration", "figure_15")
    frequency = extract.parameter(case, "frequency")
    lower, upper = exact_orbits.subharmonic_range(exact_orbits.free_of(datasets, case))
    scan = scanned(datasets, case)
    quiet = nearest_range(scan, "quiet", frequency)
    unsettled = [releases for releases in scan if both_outcomes(releases, "unsettled")]
    numbers = {
        "frequency": frequency,
        "lower": lower,
        "upper": upper,
        "inside": min(frequency - lower, upper - frequency),
        "quiet_there": max(
            (extreme_share(releases, "quiet", "non_resonance", max) for releases in quiet),
            default=np.nan,
        ),
    }
    for kind, part in (("quiet", quiet), ("unsettled", unsettled)):
        numbers[f"{kind}_first"] = float(part[0].frequency) if part else np.nan
        numbers[f"{kind}_last"] = float(part[-1].frequency) if part else np.nan
    for kind in ("quiet", "unsettled"):
        numbers[f"{kind}_goal"] = extreme_share(case, kind, "non_resonance", max)
        numbers[f"{kind}_subharmonic"] = extreme_share(case, kind, "subharmonic", max)
        numbers[f"{kind}_resonance"] = extreme_share(case, kind, "resonance", max)
    return numbers | by_policy(datasets, case)


def total_cycles(datasets):
    """Measures of claim 14: a run takes at most 350 cycles in total; from the runs of all cases."""
    runs = cases(datasets)
    within = [float(run.within_share.sel(bound="share")) for run in runs]
    reached = [run.trial_outcome == flag("trial_outcome", "reached") for run in runs]
    medians = [
        float(run.switchings.where(arrived).median())
        for run, arrived in zip(runs, reached, strict=True)
    ]
    return {
        "most": np.mean(np.array(within) >= 0.5),
        "within": min(within),
        "worst": extract.parameter(runs[int(np.argmin(within))], "frequency"),
        "runs": runs[int(np.argmin(within))].sizes["trial"],
        "never": max(1 - float(arrived.mean()) for arrived in reached),
        "switchings": max((median for median in medians if median > 0), default=np.nan),
        "median": max(float(run.total_time.median()) for run in runs),
        "longest": max(float(run.total_time.max()) for run in runs),
        "damper": max(float(run.damper_time.median()) for run in runs),
    } | by_policy(datasets, runs[int(np.argmin(within))])


def early_release(datasets):
    """Measures of claim 19: early release at W = 1.85 leads to period 3, then to period 1."""
    case = extract.get(datasets, "migration", "figure_16")
    counts = case.destination_count.sel(damped_motion="unsettled")
    total = float(counts.sum())
    return {
        "early": float(counts.sel(free_motion="subharmonic")) / total if total else np.nan,
        "goal": float(counts.sel(free_motion="non_resonance")) / total if total else np.nan,
        "resonance": float(counts.sel(free_motion="resonance")) / total if total else np.nan,
        "releases": int(total),
        "runs": case.sizes["trial"],
        "reached": float(case.reached_share.sel(bound="share")),
        "switchings": float(case.switchings.median()),
        "cycles": float(case.total_time.median()),
    } | by_policy(datasets, case)


CLAIMS = (
    Claim(
        number="12",
        text="W = 1.95: released at any phase, the motion goes to the non-resonance branch.",
        source="section 5 (i), figure 13",
        interpretation="The steady state is the quiet motion with the damper, released at evenly "
        "spaced phases. Releases before the motion has settled count for full agreement.",
        measures=(
            Measure(
                "quiet",
                "share of releases of the quiet motion to the non-resonance branch",
                least=1,
                decisive=True,
            ),
            Measure(
                "unsettled",
                "share of releases of the unsettled motion to the non-resonance branch",
                least=1,
            ),
            Measure(
                "unsettled_subharmonic",
                "share of releases of the unsettled motion to the one-third subharmonic",
            ),
            Measure(
                "unsettled_resonance",
                "share of releases of the unsettled motion to the resonance branch",
            ),
        ),
        evidence=any_phase,
        finding=migration_findings.any_phase,
        figures=("figure_13",),
    ),
    Claim(
        number="13",
        text="W = 1.7: the release phase decides between the period-1 and the period-3 motion.",
        source="section 5 (ii), figure 14",
        interpretation="Releases of the quiet motion with the damper, at evenly spaced phases, "
        "must lead to both motions, and without the damper the period-3 motion must exist at W = "
        "1.7. Releases before the motion has settled, and other frequencies, are reported as "
        "well.",
        measures=(
            Measure(
                "inside",
                "distance in W from the ends of the free one-third subharmonic, negative outside",
                least=0,
                decisive=True,
            ),
            Measure("lower", "W of the fold at which the free one-third subharmonic begins"),
            Measure("upper", "W of the fold at which the free one-third subharmonic ends"),
            Measure("frequency", "W of the case"),
            Measure(
                "quiet_goal",
                "share of releases of the quiet motion to the non-resonance branch",
                least=0.01,
                most=0.99,
                decisive=True,
            ),
            Measure(
                "quiet_subharmonic",
                "share of releases of the quiet motion to period 3",
                least=0.01,
                most=0.99,
                decisive=True,
            ),
            Measure(
                "unsettled_goal",
                "share of releases of the unsettled motion to the non-resonance branch",
            ),
            Measure(
                "unsettled_subharmonic", "share of releases of the unsettled motion to period 3"
            ),
            Measure(
                "unsettled_resonance",
                "share of releases of the unsettled motion back to the resonance branch",
            ),
            Measure(
                "quiet_first",
                "lowest W of the nearest range in which releases of the quiet motion lead to both",
            ),
            Measure("quiet_last", "highest W of this range"),
            Measure(
                "quiet_there", "largest share of releases to the non-resonance branch in this range"
            ),
            Measure(
                "unsettled_first",
                "lowest scanned W at which releases of the unsettled motion lead to both",
            ),
            Measure("unsettled_last", "highest scanned W of this kind"),
            Measure(
                "by_hold",
                "share of runs to the non-resonance branch within 350 cycles, released after a "
                "fixed number of cycles, the best one",
            ),
            Measure("by_phase", "the same share, released at the best phase"),
        ),
        evidence=release_phase,
        finding=migration_findings.release_phase,
        figures=("figure_14",),
    ),
    Claim(
        number="14",
        text="Several switchings, in total not more than 350 cycles, reach the non-resonance "
        "branch.",
        source="section 5",
        interpretation="Cycles of the forcing are counted from first switching the damper on "
        "until the motion without it has settled. At the least favourable frequency half of the "
        "runs must arrive in time, for full agreement all.",
        measures=(
            Measure(
                "within",
                "least share of runs that arrive within 350 cycles",
                least=0.5,
                decisive=True,
            ),
            Measure("within", "least share of runs that arrive within 350 cycles", least=1),
            Measure("worst", "W of the case with this least share"),
            Measure("most", "share of cases in which half of the runs arrive within 350 cycles"),
            Measure("never", "largest share of runs that never arrive"),
            Measure(
                "switchings", "largest median over the cases of the switchings of runs that arrive"
            ),
            Measure(
                "median",
                "largest median over the cases of the cycles of all runs, including runs cut off "
                "at the limit",
            ),
            Measure("longest", "largest number of cycles of a run, possibly the limit"),
            Measure(
                "damper", "largest median over the cases of the cycles with the damper on, all runs"
            ),
            Measure(
                "by_state",
                "share of runs at the worst W that arrive within 350 cycles if the damper is let "
                "go of as soon as the state lies in the basin of the goal",
            ),
            Measure("by_state_least", "lower end of the 95 % interval of this share"),
            Measure("by_state_most", "upper end of this interval"),
            Measure("by_state_cycles", "median number of cycles of these runs"),
            Measure("through", "share of states before settling at the worst W in this basin"),
            Measure(
                "by_clairvoyant", "this share for a controller that knows the state and the future"
            ),
            Measure("by_clairvoyant_least", "lower end of the 95 % interval of this share"),
            Measure("by_clairvoyant_cycles", "median number of cycles of these runs"),
        ),
        evidence=total_cycles,
        finding=migration_findings.total_cycles,
        figures=("figure_15",),
    ),
    Claim(
        number="19",
        text="W = 1.85: released before the steady state, the motion goes to the period-3 "
        "branch; several switchings then lead to period 1.",
        source="section 5 (iii), figure 16",
        interpretation="An early release follows a few cycles after the damper is switched on. "
        "For full agreement half of the early releases must lead to period 3, and all runs must "
        "arrive on the non-resonance branch in the end.",
        measures=(
            Measure(
                "early", "share of early releases that lead to period 3", least=0.01, decisive=True
            ),
            Measure("early", "share of early releases that lead to period 3", least=0.5),
            Measure("goal", "share of early releases that lead to the non-resonance branch"),
            Measure("reached", "share of runs that arrive in the end", least=0.5, decisive=True),
            Measure("reached", "share of runs that arrive in the end", least=1),
            Measure("switchings", "median number of switchings"),
            Measure("cycles", "median number of cycles"),
            Measure(
                "by_hold",
                "share of runs that arrive within 350 cycles, released early after a fixed number "
                "of cycles, the best one",
            ),
            Measure(
                "by_state",
                "the same share, released as soon as the state lies in the basin of the goal",
            ),
            Measure("by_state_cycles", "median number of cycles of these runs"),
        ),
        evidence=early_release,
        finding=migration_findings.early_release,
        figures=("figure_16",),
    ),
)
