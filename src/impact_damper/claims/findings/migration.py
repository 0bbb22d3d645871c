"""Findings on migration control: claims 12, 13, 14 and 19."""

from impact_damper.claims.findings.words import number, part_of, percent


def any_phase(quiet, unsettled, unsettled_subharmonic, unsettled_resonance, **others):
    """Return the finding on claim 12."""
    elsewhere = ""
    if unsettled != 1:
        elsewhere = (
            f", while {percent(unsettled_subharmonic)} lead to the one-third subharmonic and "
            f"{percent(unsettled_resonance)} back to resonance"
        )
    return (
        f"At W = 1.95 {part_of(quiet, 'the releases')} of the settled quiet motion lead to the "
        "non-resonance branch; of the releases before the motion has settled "
        f"{part_of(unsettled, 'them')} do{elsewhere}."
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
    **others,
):
    """Return the finding on claim 13."""
    here = "also" if inside >= 0 else "not"
    decides = ""
    if quiet_first == quiet_first:
        decides = (
            " The phase of release decides between the two at the frequencies scanned from W = "
            f"{number(quiet_first, 4)} to {number(quiet_last, 4)}."
        )
    return (
        f"Without the damper the period-3 motion exists from W = {number(lower, 5)} to "
        f"{number(upper, 5)}, {here} at W = {number(frequency)} ({number(inside)} inside this "
        f"range). There {part_of(quiet_goal, 'the releases')} of the quiet motion lead to the "
        f"non-resonance branch and {part_of(quiet_subharmonic, 'them')} to period 3.{decides}"
    )


def total_cycles(worst, within, by_state, **others):
    """Return the finding on claim 14."""
    rescued = ""
    if by_state == by_state:
        rescued = (
            "; release as soon as the state lies in the basin of this branch does so in "
            f"{percent(by_state)}"
        )
    return (
        f"At W = {number(worst)}, the least favourable frequency, {part_of(within, 'the runs')} "
        f"with random release settle on the non-resonance branch within 350 cycles{rescued}."
    )


def early_release(early, goal, reached, switchings, cycles, **others):
    """Return the finding on claim 19."""
    return (
        f"At W = 1.85 {percent(early)} of the early releases lead to period 3, {percent(goal)} to "
        f"the non-resonance branch and the others elsewhere; {part_of(reached, 'the runs')} "
        f"arrive at the latter in the end, after {number(switchings)} switchings and "
        f"{number(cycles)} cycles in the median."
    )
