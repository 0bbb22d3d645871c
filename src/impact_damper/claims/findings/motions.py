"""Findings on motions, optimum, contact and subharmonic: claims 5, 6, 8 to 11, 15 and 18."""

from impact_damper.claims.findings.words import between, number, part_of, percent


def quiet_contacts(two, skew, **others):
    """Return the finding on claim 5."""
    where = "the whole" if two == 1 else f"no more than {percent(two)} of the"
    return (
        f"Over {where} suppression band of each elastic damper there are stable quiet orbits, all "
        "with two contacts a cycle; half a cycle later each is its own mirror image to within "
        f"{number(skew, 1)}."
    )


def high_and_chaotic(more, fewest, error, widest, **others):
    """Return the finding on claim 6."""
    few = "" if fewest > 2 else f", though some stable violent orbits have only {number(fewest)}"
    ranges = "The chaotic ranges are narrow: the widest"
    if widest > 0.1:
        ranges = "But the chaotic ranges are not narrow: one"
    return (
        f"Of the violent motions {percent(more)} have more than two contacts a cycle{few}. "
        f"Harmonic balance differs from the stable violent orbits by {percent(error)} in the "
        f"median. {ranges} is {number(widest, 2)} wide in W."
    )


def first_collisions(literal, within_gap, beyond_wall, wait, **others):
    """Return the finding on claim 8."""
    return (
        f"For the least favourable damper {part_of(literal, 'random starts')} in the ball lead to "
        f"a collision; the first comes after {number(wait)} cycles at the latest. Up to "
        f"{percent(beyond_wall)} of these starts lie beyond a wall; of the starts within the gap "
        f"{percent(within_gap)} lead to a collision."
    )


def optimum(least, most, dampings, spread, displaced, **others):
    """Return the finding on claim 9."""
    return (
        f"For {number(dampings)} values of h the numerical optimum of d0 lies "
        f"{between(least, most)} above (19). The least max |Z1| varies by {percent(spread)} over "
        f"rm, and 10 % away from the optimum d0 max |Z1| is at most {percent(displaced)} of the "
        "free resonance."
    )


def reappearance(light, light_anywhere, light_ratio, heavy, ratio, **others):
    """Return the finding on claim 10."""
    within = "no stable motion whose period is a multiple of 3 is left in the band"
    if light != 0:
        within = (
            "stable motions whose period is a multiple of 3 are left in the band over a range of "
            f"W {number(light, 2)} wide"
        )
    outside = ""
    if light_anywhere != 0:
        outside = (
            "; in the range of W of the free subharmonic such motions are left over "
            f"{number(light_anywhere, 2)} in W, with at most {percent(light_ratio)} of its "
            "amplitude"
        )
    return (
        f"With rm = 0.12 and 0.25 {within}{outside}. With rm = 0.4 such motions exist in the band "
        f"over {number(heavy, 2)} in W, with at most {percent(ratio)} of the amplitude of the "
        "free subharmonic."
    )


def restitution(band, amplitude, most, clearance, step, flat, **others):
    """Return the finding on claim 11."""
    sizes = between(amplitude, most, lambda value: number(value, 2))
    steadily = f"and falls to {percent(step)} or less at each step to a lower e"
    if step > 1:
        steadily = f"but on the way it rises by up to {percent(step - 1)} at a step to a lower e"
    return (
        f"With e = 0.75 the band is at least {number(band, 2)} times as wide as with e = 1, and "
        f"max |Z1| in it is {sizes} times as large. The optimum d0 at the lowest e is at most "
        f"{percent(clearance)} of the optimum at the highest e, {steadily}. The range of d0 near "
        f"the optimum becomes at least {number(flat, 2)} times as wide at each step."
    )


def contact_model(high, low, realised, duration, **others):
    """Return the finding on claim 15."""
    only = "only " if duration < 1.2 else ""
    return (
        f"Walls that cannot pull would return up to {percent(high)} more than e for the e of the "
        f"figures, and {percent(low)} more for e = 0.3. In the quiet motions of figure 10 "
        f"the ratio of speeds at a contact differs from e by {percent(realised)}. The contact at "
        f"e = 0.3, whose length is the paper's reason, is {only}{number(duration)} times "
        "as long as at e = 1."
    )


def subharmonic_by_damping(low, high, fall, relative, unchanged, unchanged_high, **others):
    """Return the finding on claim 18."""
    return (
        "Averaged over random starts and W, the damper lowers the amplitude of the subharmonic "
        f"by {number(low, 2)} at h = 0.107 and by {number(high, 2)} at h = 0.215: {number(fall)} "
        f"times as much, and {number(relative, 4)} times as much relative to the free amplitude. "
        "A stable subharmonic of at least 95 % of the free amplitude remains over "
        f"{percent(unchanged)} of the range at h = 0.107 and over {percent(unchanged_high)} at h "
        "= 0.215."
    )
