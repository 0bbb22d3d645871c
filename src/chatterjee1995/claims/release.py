"""Claims 12 and 13, on where a release of the damper leads (section 5, figures 13 and 14).

Release means switching the damper off. Without the damper the oscillator has a large motion on the
resonance branch, a small one on the non-resonance branch, and in a range of frequencies a motion of
period 3, the one-third subharmonic. A case is a dataset of releases for one oscillator, damper and
frequency W. A scan holds such datasets for many W. The kind of a damped motion is "quiet", for the
small motion of period 1, "subharmonic" for a longer period, or "unsettled".
"""

import numpy as np

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import Claim, Measure
from chatterjee1995.claims.findings import migration as migration_findings
from chatterjee1995.claims.policies import LEAST, by_policy, extreme_share, release_shares
from impact_damper.data.datasets import damper_of, oscillator_of


def any_phase(datasets):
    """Return the measures of claim 12, on releases at W = 1.95 at any phase.

    By this claim all lead to the non-resonance branch.
    """
    case = extract.get(datasets, "migration", "figure_13")
    return {
        "releases": extract.parameter(case, "releases"),
        "quiet": extreme_share(case, "quiet", "non_resonance", min),
        "unsettled": extreme_share(case, "unsettled", "non_resonance", min),
        "unsettled_subharmonic": extreme_share(case, "unsettled", "subharmonic", max),
        "unsettled_resonance": extreme_share(case, "unsettled", "resonance", max),
    }


def both_outcomes(case, kind, least=0.0):
    """Return whether some releases of one damped motion lead to period 3 and others to the goal.

    The goal is the non-resonance branch. Both shares of the releases must exceed `least`.
    """
    goal, third = (release_shares(case, kind, name) for name in ("non_resonance", "subharmonic"))
    return bool(np.any((goal > least) & (third > least)))


def scanned(datasets, case):
    """Return the datasets of release scans with a case's oscillator and damper, one for each W.

    They are sorted by rising W.
    """
    wanted = oscillator_of(case), damper_of(case)
    found = [
        scan.isel(frequency=k)
        for scan in datasets.get("release_scan", {}).values()
        if (oscillator_of(scan), damper_of(scan)) == wanted
        for k in range(scan.sizes["frequency"])
    ]
    return sorted(found, key=lambda here: float(here.frequency))


def nearest_range(scan, kind, frequency):
    """Return the range of a scan nearest to a frequency in which `both_outcomes` is true.

    The range is a list of neighbouring entries of `scan`, the result of `scanned`. It is empty if
    there is none.
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
    """Return the measures of claim 13: at W = 1.7 the phase decides between period 1 and 3."""
    case = extract.get(datasets, "migration", "figure_15")
    frequency = extract.parameter(case, "frequency")
    lower, upper = exact_orbits.subharmonic_range(exact_orbits.free_of(datasets, case))
    scan = scanned(datasets, case)
    quiet = nearest_range(scan, "quiet", frequency)
    unsettled = [releases for releases in scan if both_outcomes(releases, "unsettled")]
    longer = [releases for releases in scan if both_outcomes(releases, "subharmonic", LEAST)]
    numbers = {
        "frequency": frequency,
        "lower": lower,
        "upper": upper,
        "inside": min(frequency - lower, upper - frequency),
    }
    for choose, end in ((min, "least"), (max, "most")):
        goal = [extreme_share(each, "quiet", "non_resonance", choose) for each in quiet]
        third = [extreme_share(each, "subharmonic", "subharmonic", choose) for each in longer]
        numbers[f"quiet_{end}"] = choose(goal, default=np.nan)
        numbers[f"longer_{end}"] = choose(third, default=np.nan)
    for kind, part in (("quiet", quiet), ("unsettled", unsettled), ("longer", longer)):
        numbers[f"{kind}_first"] = float(part[0].frequency) if part else np.nan
        numbers[f"{kind}_last"] = float(part[-1].frequency) if part else np.nan
    for kind in ("quiet", "unsettled"):
        numbers[f"{kind}_goal"] = extreme_share(case, kind, "non_resonance", max)
        numbers[f"{kind}_subharmonic"] = extreme_share(case, kind, "subharmonic", max)
        numbers[f"{kind}_resonance"] = extreme_share(case, kind, "resonance", max)
    return numbers | by_policy(datasets, case)


CLAIMS = (
    Claim(
        number="12",
        text="W = 1.95: released at any phase, the motion goes to the non-resonance branch.",
        source="section 5 (i), figure 13",
        interpretation="The paper releases the steady state, which is read as the settled quiet "
        "motion with the damper, released at phases evenly spaced over its period. Releases before "
        "the motion has settled do not affect the verdict.",
        measures=(
            Measure(
                "quiet",
                "share of releases of the quiet motion to the non-resonance branch",
                least=1,
                decisive=True,
            ),
            Measure(
                "unsettled", "share of releases of the unsettled motion to the non-resonance branch"
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
        interpretation="Releases of the settled quiet motion with the damper, at evenly spaced "
        "phases, must lead to both motions, each in 1 % of the releases at least, and without the "
        "damper the period-3 motion must exist at W = 1.7. Other frequencies, a settled motion of "
        "a longer period, and releases before the motion has settled are reported as well.",
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
                least=LEAST,
                most=1 - LEAST,
                decisive=True,
            ),
            Measure(
                "quiet_subharmonic",
                "share of releases of the quiet motion to period 3",
                least=LEAST,
                most=1 - LEAST,
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
                "lowest W of the range, nearest to the W of the claim, in which some releases of "
                "the quiet motion lead to the non-resonance branch and some to period 3",
            ),
            Measure("quiet_last", "highest W of this range"),
            Measure(
                "quiet_least", "least share of releases to the non-resonance branch in this range"
            ),
            Measure(
                "quiet_most", "largest share of releases to the non-resonance branch in this range"
            ),
            Measure(
                "longer_first",
                "lowest scanned W at which a settled motion of a longer period leads to the "
                "non-resonance branch and to period 3, each in 1 % of its releases at least",
            ),
            Measure("longer_last", "highest scanned W at which such a motion does so"),
            Measure("longer_least", "least share of its releases to period 3"),
            Measure("longer_most", "largest share of its releases to period 3"),
            Measure(
                "unsettled_first",
                "lowest scanned W at which releases of the unsettled motion lead to the "
                "non-resonance branch and to period 3",
            ),
            Measure("unsettled_last", "highest scanned W at which they do so"),
            Measure(
                "by_hold",
                "share of runs to the non-resonance branch within 350 cycles, released after the "
                "best fixed number of cycles",
            ),
            Measure("by_phase", "the same share, released at the best phase"),
        ),
        evidence=release_phase,
        finding=migration_findings.release_phase,
        figures=("figure_14",),
    ),
)
