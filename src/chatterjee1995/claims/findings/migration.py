"""Findings on migration control: claims 12, 13, 14 and 19.

Each function takes the measures of one claim as keyword arguments. The modules of the claims
(`claims.release`, `claims.migration`) say what each measure means.
"""

import math

from chatterjee1995.claims.findings.words import between, listed, number, part_of, percent


def any_phase(quiet, releases, unsettled, unsettled_subharmonic, unsettled_resonance, **others):
    """Return the finding on claim 12."""
    elsewhere = {
        "to the one-third subharmonic": unsettled_subharmonic,
        "back to resonance": unsettled_resonance,
    }
    ends = "".join(
        f"; {percent(share)} lead {end}" for end, share in elsewhere.items() if share != 0
    )
    return (
        f"At W = 1.95 {part_of(quiet, 'releases', releases)} of the settled quiet motion lead to "
        "the non-resonance branch. Of the releases before the motion has settled, which the claim "
        f"does not concern, {percent(unsettled)} do{ends}."
    )


def release_phase(
    frequency, lower, upper, inside, quiet_goal, quiet_subharmonic, quiet_first, quiet_last,
    quiet_least, quiet_most, longer_first, longer_last, longer_least, longer_most, by_hold,
    by_phase, **others,
):  # fmt: skip
    """Return the finding on claim 13."""
    third = "none" if quiet_subharmonic == 0 else percent(quiet_subharmonic)
    decides = ""
    if not math.isnan(quiet_first):
        decides = (
            " Among the frequencies scanned the phase of release of the quiet motion decides "
            f"between both from W = {number(quiet_first, 4)} to {number(quiet_last, 4)}, where "
            f"{between(quiet_least, quiet_most)} of the phases lead to the non-resonance branch."
        )
    longer = ""
    if not math.isnan(longer_first):
        longer = (
            " With a settled motion of a longer period it decides from W = "
            f"{number(longer_first, 4)} to {number(longer_last, 4)}, where "
            f"{between(longer_least, longer_most)} of the phases lead to period 3."
        )
    early = ""
    if not math.isnan(by_phase):
        early = (
            f" Repeated early releases are a different test: at W = {number(frequency)} "
            f"{percent(by_phase)} of the runs arrive on the non-resonance branch within 350 "
            f"cycles if each release is at the best phase, and {percent(by_hold)} if it is at a "
            "random phase after the best fixed number of cycles."
        )
    return (
        f"Without the damper the period-3 motion exists from W = {number(lower, 5)} to "
        f"{number(upper, 5)}, and so {'also' if inside >= 0 else 'not'} at W = "
        f"{number(frequency)}. There {part_of(quiet_goal, 'releases')} of the quiet motion lead "
        f"to the non-resonance branch and {third} to period 3.{decides}{longer}{early}"
    )


def total_cycles(best, within, worst, cases, by_state, by_state_least, by_state_most, **others):
    """Return the finding on claim 14."""
    shares = listed(
        f"{part_of(case['within'], 'runs', case['runs'])} at W = {number(case['frequency'], 4)}"
        for case in cases
    )
    longest = ""
    if all(case["hold"] for case in cases):
        longest = f", at the latest after {listed(str(case['hold']) for case in cases)} cycles"
    fixed = ""
    if not any(math.isnan(case["by_hold"]) for case in cases):
        by_hold = listed(percent(case["by_hold"]) for case in cases)
        fixed = f" If it is released after the best fixed number of cycles, {by_hold} do."
    state = ""
    if not math.isnan(by_state):
        state = (
            " Released as soon as the state lies in the basin of this branch, "
            f"{percent(by_state)} (95 % interval {percent(by_state_least)} to "
            f"{percent(by_state_most)}) do at W = {number(worst, 4)}."
        )
    return (
        f"The non-resonance branch is reached within 350 cycles by {shares}, if the damper is "
        f"released when its motion has settled{longest}.{fixed} At the least favourable W "
        f"{percent(within)} do in the first way, and {percent(best)} in the better way.{state}"
    )


def early_release(
    early, goal, resonance, releases, of_others, hold, later, later_resonance, later_of_others,
    by_way, reached, runs, switchings, cycles, by_state, by_state_cycles, **others,
):  # fmt: skip
    """Return the finding on claim 19."""
    after = "" if hold is None else f" after about {hold} cycles"
    whenever = ""
    if not math.isnan(later):
        whenever = (
            f" Of releases at any time before the motion has settled {percent(later)} lead to "
            f"period 3. The difference is in the returns to resonance, {percent(resonance)} and "
            f"{percent(later_resonance)}: of the other releases {percent(of_others)} and "
            f"{percent(later_of_others)} lead to period 3."
        )
    sooner = ""
    if not math.isnan(by_state):
        sooner = (
            " Released as soon as the state lies in the basin of this branch, "
            f"{part_of(by_state, 'runs')} arrive within 350 cycles, in the median after "
            f"{number(by_state_cycles)}."
        )
    return (
        f"At W = 1.85 {percent(early)} of the {releases} early releases{after} lead to period 3, "
        f"{percent(goal)} to the non-resonance branch and {percent(resonance)} back to "
        f"resonance.{whenever} In the end {part_of(reached, 'runs', runs)} arrive on the "
        f"non-resonance branch, in the median after {number(switchings)} switchings and "
        f"{number(cycles)} cycles; {percent(by_way)} reach period 3 on the way, as the paper's "
        f"run does.{sooner}"
    )
