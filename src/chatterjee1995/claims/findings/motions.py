"""Findings on motions, optimum, contact and subharmonic: claims 5, 6, 8 to 11, 15 and 18.

Each function takes the measures of one claim as keyword arguments. The modules of the claims
(`claims.motions`, `optimum`, `contact`, `subharmonic`) say what each measure means.
"""

import math
from functools import partial

from chatterjee1995.claims.findings.words import between, listed, number, part_of, percent
from impact_damper.data.table_files import in_words


def quiet_contacts(two, skew, **others):
    """Return the finding on claim 5."""
    where = "the whole" if two == 1 else f"no more than {percent(two)} of the"
    return (
        f"Over {where} suppression band of each damper there are stable quiet orbits, all with "
        "two contacts a cycle; motions without contact may exist beside them. Half a cycle later "
        "the state of each is its mirror image: none of Z1, Z1', Z2 and Z2' differs by more than "
        f"{number(skew, 1, 'up')}, in dimensionless units."
    )


def high_and_chaotic(
    more, fewest, fewest_in, harmonic, coexisting, coexisting_in, widest, widest_in, widest_first,
    **others,
):  # fmt: skip
    """Return the finding on claim 6."""
    few = ""
    if not fewest > 2:
        few = (
            f"; but in {in_words(fewest_in)} stable violent orbits exist that have only "
            f"{number(fewest)}, and are not symmetric"
        )
    apart = "Regions of different contact number overlap by at most"
    if coexisting > 0.005:
        apart = (
            "Regions of different contact number are not separated: stable violent orbits with "
            "different numbers coexist over up to"
        )
    narrow = "narrow" if widest <= 0.1 else "not narrow"
    return (
        f"Of the violent motions, chaotic ones included, {percent(more)} have more than two "
        f"contacts a cycle{few}. The amplitude |a| of harmonic balance differs from the first "
        f"harmonic of the stable violent orbits by {percent(harmonic)} in the median. {apart} "
        f"{number(coexisting, 2, 'up')} in W ({in_words(coexisting_in)}). The chaotic ranges, "
        f"transients included, are {narrow}: in figure 5 (a) the widest is "
        f"{number(widest_first, 2)} wide in W, and the widest of all {number(widest, 2)} "
        f"({in_words(widest_in)})."
    )


def first_collisions(literal, within_gap, starts, clearances, beyond_walls, waits, **others):
    """Return the finding on claim 8."""
    ball, gap = (
        f"{'' if share == 1 else 'at least '}{part_of(share, 'random starts', starts)}"
        for share in (literal, within_gap)
    )
    return (
        f"For the dampers of figure 5, with d0 = {listed(map(number, clearances))}, {ball} in the "
        f"ball lead to a collision, and {gap} in the part of the ball within the gap. Of the "
        f"starts in the ball {listed(map(percent, beyond_walls))} lie beyond a wall. Starts "
        "within the gap have their first collision after at most "
        f"{listed(f'{wait:.0f}' for wait in waits)} cycles."
    )


def optimum(least, most, dampings, rule_least, rule_most, spread, rise_least, rise, displaced,
            **others):  # fmt: skip
    """Return the finding on claim 9."""
    but = " But if" if rise > 0.2 else " If"
    return (
        f"For {number(dampings)} values of h the numerical optimum of d0 lies "
        f"{between(least, most)} above the optimum by (7), and {between(rule_least, rule_most)} "
        f"above (19). The least max |Z1| varies by {percent(spread)} over rm.{but} d0 is changed "
        f"by 10 % from the optimum, max |Z1| rises by {between(rise_least, rise)} in the worse "
        f"direction. Max |Z1| is then at most {percent(displaced, 'up')} of the free resonance."
    )


def reappearance(
    light, light_anywhere, light_ratio, narrow_ratio, narrow_width, heavy, ratio, heavy_ratio,
    low_damping, low_ratio, **others,
):  # fmt: skip
    """Return the finding on claim 10."""
    within = "no stable motion whose period is a multiple of 3 was found in the band"
    if light != 0:
        within = (
            "stable motions whose period is a multiple of 3 were found in the band over up to "
            f"{number(light, 2, 'up')} in W"
        )
    outside = ""
    if light_anywhere != 0:
        outside = (
            " Between the folds of the free subharmonic such motions were found over up to "
            f"{number(light_anywhere, 2, 'up')} in W"
        )
        outside += (
            "."
            if math.isnan(light_ratio)
            else f", with at most {percent(light_ratio, 'up')} of its amplitude."
        )
        if not math.isnan(narrow_ratio):
            outside += (
                f" A branch that is stable over only {number(narrow_width, 1)} in W has up to "
                f"{percent(narrow_ratio, 'up')}."
            )
    below = ""
    if heavy_ratio > ratio:
        below = "; outside the band, between the folds, they have up to "
        below += f"{percent(heavy_ratio, 'up')}, on a branch with a short stable part (drawn among "
        below += "the exact orbits)"
    other = "leaves no such motion in its band"
    if low_damping != 0:
        other = (
            f"leaves such motions at {part_of(low_damping, 'frequencies')} of its band, with up "
            f"to {percent(low_ratio, 'up')} of the free amplitude"
        )
    return (
        f"For h = 0.215, with rm = 0.12 and 0.25, {within}.{outside} With rm = 0.4 such motions "
        f"exist in the band over {number(heavy, 2)} in W, with at most {percent(ratio, 'up')} of "
        f"the amplitude of the free subharmonic{below}. For h = 0.107 the damper of figure 8 "
        f"{other}."
    )


def restitution(
    band, amplitude, most, clearance_least, clearance, step, step_mass_ratio, step_from, step_to,
    rising, flat, absolute, **others,
):  # fmt: skip
    """Return the finding on claim 11."""
    sizes = between(amplitude, most, partial(number, digits=2))
    marginal = ", which is more than marginal" if most > 1.5 else ""
    steadily = f"each step to a lower e lowers it, to {percent(step, 'up')} or less"
    if step > 1:
        only = "in one case" if rising == 1 else f"in {rising} cases, the worst"
        steadily = (
            f"only {only}, from e = {number(step_from)} to {number(step_to)} with rm = "
            f"{number(step_mass_ratio)}, it rises, by {percent(step - 1)}"
        )
    flatter = "falls to at most" if flat <= 1 else "changes to up to"
    grown = f"the rise falls to at most {percent(absolute, 'up')}"
    if absolute > 1:
        grown = f"the rise grows by {percent(absolute - 1, 'up')} in the worst step"
    return (
        f"For rm = 0.25 and d0 = 1 the band with e = 0.75 is at least {number(band, 2)} times as "
        f"wide as with e = 1, and max |Z1| in the elastic band {sizes} times as large{marginal}. "
        f"The optimum d0 at the lowest e is {between(clearance_least, clearance)} of the optimum "
        f"at e = 1; {steadily}. At each step the relative rise of max |Z1| at 10 % from the "
        f"optimum d0 {flatter} {percent(flat, 'up')} of its value before; in units of Z1 {grown}."
    )


def contact_model(high, low, realised, duration, **others):
    """Return the finding on claim 15."""
    only = "only " if duration < 1.2 else ""
    return (
        "With walls that cannot pull, the coefficient of restitution would exceed e by up to "
        f"{percent(high, 'up')} for the e of the figures, and by {percent(low)} for e = 0.3. In "
        "the quiet motions of figure 10 the ratio of the speeds after and before a contact "
        f"differs from e by at most {percent(realised, 'up')}. The paper's reason is the longer "
        f"contact; at e = 0.3 a contact is {only}{number(duration)} times as long as at e = 1. By "
        "our criterion the model fails there because its walls pull."
    )


def subharmonic_by_damping(
    low, high, fall, relative, relative_low, relative_high, unchanged, unchanged_high, starts,
    starts_high, **others,
):  # fmt: skip
    """Return the finding on claim 18."""
    alike = "nearly the same" if abs(relative - 1) < 0.05 else "not the same"
    return (
        "Averaged over random starts and W, the damper lowers the amplitude of the subharmonic by "
        f"{percent(relative_low)} of the free amplitude at h = 0.107 and by "
        f"{percent(relative_high)} at h = 0.215, which is {alike}: the ratio is "
        f"{number(relative, 4)}. In units of Z1 the fall is {number(low, 2)} and "
        f"{number(high, 2)}, {number(fall)} times as large at h = 0.107, because the free "
        f"amplitude is larger there. Of the starts {percent(starts)} and {percent(starts_high)} "
        "still lead to a subharmonic. However few they are, a stable one of at least 95 % of the "
        f"free amplitude remains over {percent(unchanged)} of the free subharmonic's range at h = "
        f"0.107, and over {percent(unchanged_high)} at h = 0.215."
    )
