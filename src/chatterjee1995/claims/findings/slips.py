"""Findings on S1 to S6, misprints and omissions of the paper.

Each function takes the measures of one of them as keyword arguments. The module `claims.slips` says
what each measure means. The sentences use the symbols and numbers of equations of the paper.
"""

from chatterjee1995.claims.findings.words import number, part_of, percent


def penetration(power, corrected, printed, **others):
    """Return the finding on S1."""
    return (
        f"B grows as the power {number(power)} of eps. The printed expression, with the power "
        f"1/2, is {number(printed)} times B in the median of the solutions computed; the "
        f"expansion of (6e), with the power 3/2, agrees with B to {percent(abs(corrected - 1))}."
    )


def captions(a, b, printed_a, printed_b, rule_a, rule_b, **others):
    """Return the finding on S2."""
    return " ".join(
        f"In ({panel}) rule (19) gives d0 = {number(ruled)}; the printed {number(printed)} is "
        f"{_rounding(distance)} of this value."
        for panel, printed, ruled, distance in (
            ("a", printed_a, rule_a, a),
            ("b", printed_b, rule_b, b),
        )
    )


def state_size(components, printed, quiet, **others):
    """Return the finding on S3."""
    return (
        f"A state, at a given phase of the forcing, is {number(components)} numbers, Z1, Z1', Z2 "
        f"and Z2'; the paper prints {number(printed)}. At the W of figure 4 "
        f"{part_of(quiet, 'random starts')} lead to the quiet motion that is drawn."
    )


def design_point(rounding, printed, ruled, inertia, **others):
    """Return the finding on S4."""
    return (
        f"With rm = 0.12 and W = 2 the product rm W^2 d0 is 1 for d0 = {number(ruled)}. The "
        f"printed {number(printed)} is {_rounding(rounding)} of this value; the product is then "
        f"{number(inertia)}."
    )


def peaks(**values):
    """Return the finding on S5."""
    dampings = [name.removeprefix("off_") for name in values if name.startswith("off_")]
    return " ".join(
        f"For h = {damping} the peak by harmonic balance is at W = "
        f"{number(values[f'formula_{damping}'], 4)}: the printed "
        f"{number(values[f'printed_{damping}'])} is {_rounding(values[f'off_{damping}'])} of it; "
        f"the fold of exact orbits is at {number(values[f'end_{damping}'], 4)}."
        for damping in sorted(dampings, reverse=True)
    )


def unprinted(clearance, frequency, chosen, inertia, **others):
    """Return the finding on S6."""
    return (
        f"For figure 8 the chosen d0 = {number(chosen, 4)} is {_rounding(clearance)} of the value "
        f"by (19) at the printed Wp; at the Wp by harmonic balance rm Wp^2 d0 is "
        f"{number(inertia)}. For figure 11 the chosen W is {_rounding(frequency)} of the Wp by "
        "harmonic balance."
    )


def _rounding(distance):
    """Return words for a printed number, from its distance to the computed one.

    The distance is in half units of the last printed digit (`claims.slips.misrounding`).
    """
    return "a right rounding" if distance <= 1 else "not a rounding"
