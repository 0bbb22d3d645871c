"""Findings on migration control: claims 12, 13, 14 and 19."""

import math

from impact_damper.claims.findings.words import number, part_of, percent


def any_phase(quiet, unsettled, unsettled_subharmonic, unsettled_resonance, **others):
    """Return the finding on claim 12."""
    elsewhere = {
        "to the one-third subharmonic": unsettled_subharmonic,
        "back to resonance": unsettled_resonance,
    }
    ends = "".join(
        f"; {percent(share)} lead {end}" for end, share in elsewhere.items() if share != 0
    )
    return (
        f"At W = 1.95 {part_of(quiet, 'releases')} of the settled quiet motion lead to the "
        "non-resonance branch. Of the releases before the motion has settled "
        f"{percent(unsettled)} do{ends}."
    )


def release_phase(
    frequency,
    lower,
    upper,
    inside,
    quiet_goal,
    quiet_subharmonic,
    quiet_first,
    quiet_last,
    quiet_there,
    by_hold,
    by_phase,
    **others,
):
    """Return the finding on claim 13."""
    third = "none" if quiet_subharmonic == 0 else percent(quiet_subharmonic)
    decides = ""
    if not math.isnan(quiet_first):
        decides = (
            " Of the frequencies scanned, the phase of release decides between the two from W = "
            f"{number(quiet_first, 4)} to {number(quiet_last, 4)}; there at most "
            f"{percent(quiet_there)} of the phases lead to the non-resonance branch."
        )
    early = ""
    if not math.isnan(by_phase):
        early = (
            f" Early releases that are repeated lead {percent(by_phase)} of the runs to the "
            "non-resonance branch within 350 cycles at the best fixed phase, and "
            f"{percent(by_hold)} after the best fixed number of cycles."
        )
    return (
        f"Without the damper the period-3 motion exists from W = {number(lower, 5)} to "
        f"{number(upper, 5)}, and so {'also' if inside >= 0 else 'not'} at W = "
        f"{number(frequency)}. There {part_of(quiet_goal, 'releases')} of the quiet motion lead "
        f"to the non-resonance branch and {third} to period 3.{decides}{early}"
    )


def total_cycles(
    worst, within, runs, by_state, by_state_least, by_state_most, by_clairvoyant, **others
):
    """Return the finding on claim 14."""
    rescued = ""
    if not math.isnan(by_state):
        rescued = (
            "; release as soon as the state lies in the basin of this branch does so in "
            f"{percent(by_state)} ({percent(by_state_least)} to {percent(by_state_most)}), and a "
            f"controller that knows the future in {percent(by_clairvoyant)}"
        )
    return (
        f"At W = {number(worst)}, the least favourable frequency, release at a random phase, "
        "after the damped motion has settled or the longest hold, reaches the non-resonance "
        f"branch within 350 cycles in {part_of(within, 'runs', runs)}{rescued}."
    )


def early_release(
    early,
    goal,
    resonance,
    releases,
    reached,
    runs,
    switchings,
    cycles,
    by_state,
    by_state_cycles,
    **others,
):
    """Return the finding on claim 19."""
    sooner = ""
    if not math.isnan(by_state):
        sooner = (
            f" Released as soon as the state lies in the basin, {percent(by_state)} of the runs "
            f"arrive within 350 cycles, in the median after {number(by_state_cycles)}."
        )
    return (
        f"At W = 1.85 {percent(early)} of the {releases} early releases lead to period 3, "
        f"{percent(goal)} to the non-resonance branch and {percent(resonance)} back to resonance. "
        f"In the end {part_of(reached, 'runs', runs)} arrive on the non-resonance branch, in the "
        f"median after {number(switchings)} switchings and {number(cycles)} cycles.{sooner}"
    )
