"""Findings on the slips S1 to S6."""

from impact_damper.claims.findings.words import number, percent


def penetration(power, corrected, printed, **others):
    """Return the finding on S1."""
    return (
        f"B grows as the power {number(power)} of eps. The printed expression, with the power "
        f"1/2, is {number(printed)} times B in the median of the solutions computed; the "
        f"expansion of (6e), with the power 3/2, agrees with B to {percent(abs(corrected - 1))}."
    )


def captions(a, b, rule_a, rule_b, **others):
    """Return the finding on S2."""
    return (
        f"With the peak frequency of the same omega_l rule (19) gives d0 = {number(rule_a)} in "
        f"(a) and {number(rule_b)} in (b); the captions print {percent(a)} and {percent(b)} of "
        "these values."
    )


def state_size(components, printed, **others):
    """Return the finding on S3."""
    return (
        f"A state, at a given phase of the forcing, is {number(components)} numbers, Z1, Z1', Z2 "
        f"and Z2'; the paper prints {number(printed)}."
    )


def design_point(inertia, **others):
    """Return the finding on S4."""
    return f"With rm = 0.12, d0 = 2 and W = 2 the product rm W^2 d0 is {number(inertia)}."


def peaks(worst, **others):
    """Return the finding on S5."""
    ends = ", ".join(
        f"{number(value, 4)} for h = {name.removeprefix('end_')}"
        for name, value in sorted(others.items(), reverse=True)
        if name.startswith("end_")
    )
    return (
        f"The resonance branch of exact orbits ends at W = {ends}. The printed frequencies differ "
        f"from these by up to {percent(worst)}."
    )


def unprinted(inertia, frequency, **others):
    """Return the finding on S6."""
    return (
        f"With the values chosen rm Wp^2 d0 is {number(inertia)} in figure 8, and W is "
        f"{number(frequency)} times the peak frequency in figure 11."
    )
