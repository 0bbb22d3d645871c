"""Claims 14 and 19, on runs of migration control (section 5, figures 15 and 16).

Without the damper the oscillator has a large motion on the resonance branch and a small one on the
non-resonance branch. Migration leads from the large to the small one by switching the damper on and
off again. Switching off is called release. A case is a dataset of one oscillator, damper and
frequency, with many runs. Period 3 is a motion without the damper that repeats after three forcing
cycles, the one-third subharmonic.

W is the forcing frequency. A stage is a step of the workflow.
"""

import numpy as np

from chatterjee1995.claims import extract
from chatterjee1995.claims.claim import Claim, Measure, Missing
from chatterjee1995.claims.findings import migration as migration_findings
from chatterjee1995.claims.policies import LEAST, by_policy, extreme_share
from impact_damper.data.datasets import flag, parameters_of


def cases(datasets):
    """Return all cases of migration control, or raise Missing."""
    if not datasets.get("migration"):
        raise Missing("There is no dataset of the stage migration")
    return list(datasets["migration"].values())


def total_cycles(datasets):
    """Return the measures of claim 14, from the runs of all cases.

    By this claim a run reaches the non-resonance branch within 350 cycles.
    """
    runs = sorted(cases(datasets), key=lambda run: extract.parameter(run, "frequency"))
    within = [float(run.within_share.sel(bound="share")) for run in runs]
    policies = [by_policy(datasets, run) for run in runs]
    best = [np.fmax(share, each["by_hold"]) for share, each in zip(within, policies, strict=True)]
    worst = int(np.argmin(within))
    reached = [run.trial_outcome == flag("trial_outcome", "reached") for run in runs]
    medians = [
        float(run.switchings.where(arrived).median())
        for run, arrived in zip(runs, reached, strict=True)
    ]
    return {
        "best": min(best),
        "most": np.mean(np.array(within) >= 0.5),
        "within": within[worst],
        "worst": extract.parameter(runs[worst], "frequency"),
        "cases": [
            {
                "frequency": extract.parameter(run, "frequency"),
                "hold": parameters_of(run).get("longest_hold"),
                "within": share,
                "runs": run.sizes["trial"],
                "by_hold": each["by_hold"],
            }
            for run, share, each in zip(runs, within, policies, strict=True)
        ],
        "never": max(1 - float(arrived.mean()) for arrived in reached),
        "switchings": max((median for median in medians if median > 0), default=np.nan),
        "median": max(float(run.total_time.median()) for run in runs),
        "longest": max(float(run.total_time.max()) for run in runs),
        "damper": max(float(run.damper_time.median()) for run in runs),
    } | policies[worst]


def early_release(datasets):
    """Return the measures of claim 19: early release at W = 1.85 leads to period 3, then to 1."""
    case = extract.get(datasets, "migration", "figure_16")
    counts = case.destination_count.sel(damped_motion="unsettled")
    total = float(counts.sum())

    def share(name):
        return float(counts.sel(free_motion=name)) / total if total else np.nan

    third = case.destination == flag("destination", "subharmonic")
    arrived = case.trial_outcome == flag("trial_outcome", "reached")
    later = {
        name: extreme_share(case, "unsettled", free_motion, max)
        for name, free_motion in (("later", "subharmonic"), ("later_resonance", "resonance"))
    }
    return (
        {
            "early": share("subharmonic"),
            "goal": share("non_resonance"),
            "resonance": share("resonance"),
            "of_others": _of_others(share("subharmonic"), share("resonance")),
            "hold": parameters_of(case).get("longest_hold"),
            "later_of_others": _of_others(later["later"], later["later_resonance"]),
            "by_way": float((third.any("switching") & arrived).mean()),
            "releases": int(total),
            "runs": case.sizes["trial"],
            "reached": float(case.reached_share.sel(bound="share")),
            "switchings": float(case.switchings.median()),
            "cycles": float(case.total_time.median()),
        }
        | by_policy(datasets, case)
        | later
    )


def _of_others(subharmonic, resonance):
    """Return the share of the subharmonic among the releases that do not lead to resonance.

    The arguments are the shares of the subharmonic and of the resonance among all releases.
    """
    return subharmonic / (1 - resonance) if resonance < 1 else np.nan


CLAIMS = (
    Claim(
        number="14",
        text="Several switchings, in total not more than 350 cycles, reach the non-resonance "
        "branch.",
        source="section 5",
        interpretation="Cycles of the forcing are counted from first switching the damper on "
        "until the motion without it has settled. The paper says that switchings could lead there, "
        "so at each of its three frequencies 1 % of the runs must arrive in time, by the better of "
        "two ways: with the damper on until its motion has settled, or for a fixed number of "
        "cycles, the best one. For full agreement half of the runs must arrive in time in the "
        "runs of figures 13, 15 and 16. In these runs the damper stays on until its motion has "
        "settled, but for 500 cycles at most, in figure 16 for five cycles at most. The paper "
        "gives no limit; one time of 500 cycles with the damper on already exceeds 350 cycles.",
        measures=(
            Measure(
                "best",
                "least share, over W, of runs that arrive within 350 cycles by the better way",
                least=LEAST,
                decisive=True,
            ),
            Measure(
                "within",
                "least share of runs of figures 13, 15 and 16 that arrive within 350 cycles",
                least=0.5,
            ),
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
                "share of runs at the worst W that arrive within 350 cycles if the damper is "
                "released as soon as the state lies in the basin of the goal",
            ),
            Measure("by_state_least", "lower end of the 95 % interval of this share"),
            Measure("by_state_most", "upper end of this interval"),
            Measure("by_state_cycles", "median number of cycles of these runs"),
            Measure(
                "through",
                "share of releases at the worst W, at every phase and before the motion has "
                "settled, that lead to the goal",
            ),
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
        interpretation="The paper shows one run, so period 3 must be reached by 1 % of the early "
        "releases, and half of the runs must arrive on the non-resonance branch in the end, for "
        "full agreement all. The paper does not say how early the damper was released; here it is "
        "five to seven cycles after switching it on, at a random phase.",
        measures=(
            Measure(
                "early", "share of early releases that lead to period 3", least=LEAST, decisive=True
            ),
            Measure("goal", "share of early releases that lead to the non-resonance branch"),
            Measure("resonance", "share of early releases that lead back to resonance"),
            Measure(
                "of_others",
                "share that leads to period 3 among the early releases not back to resonance",
            ),
            Measure(
                "later",
                "share of releases at any time before the motion has settled that lead to period 3",
            ),
            Measure("later_resonance", "share of these that lead back to resonance"),
            Measure(
                "later_of_others",
                "share that leads to period 3 among these releases, without those to resonance",
            ),
            Measure("by_way", "share of runs that pass through period 3 and arrive"),
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
