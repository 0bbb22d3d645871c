"""Findings on motions, optimum, contact and subharmonic: claims 5, 6, 8 to 11, 15 and 18."""

from impact_damper.claims.findings.words import between, number, part_of, percent


def quiet_contacts(two, skew, **others):
    """Return the finding on claim 5."""
    where = "the whole" if two == 1 else f"only {percent(two)} of the"
    return (
        f"Over {where} suppression band of each elastic damper there are stable quiet orbits, all "
        "with two contacts a cycle; half a cycle later each is its own mirror image to within "
        f"{number(skew, 1)}."
    )


def high_and_chaotic(more, fewest, error, widest, **others):
    """Return the finding on claim 6."""
    few = "" if fewest > 2 else f"; a stable high orbit has as few as {number(fewest)}"
    return (
        f"{part_of(more, 'the high motions').capitalize()} have more than two contacts a "
        f"cycle{few}. Harmonic balance differs from the stable high orbits by {percent(error)} in "
        f"the median. The widest range of W with a chaotic high motion is {number(widest, 2)} "
        "wide."
    )


def first_collisions(literal, within_gap, beyond_wall, wait, **others):
    """Return the finding on claim 8."""
    return (
        f"For the least favourable damper {part_of(literal, 'the random starts')} in the ball "
        f"lead to a collision, after at most {number(wait)} cycles, though up to "
        f"{percent(beyond_wall)} of the starts lie beyond a wall; within the gap "
        f"{part_of(within_gap, 'the starts')} do."
    )


def optimum(least, most, dampings, spread, displaced, **others):
    """Return the finding on claim 9."""
    return (
        f"For {number(dampings)} values of h the numerical optimum of d0 lies "
        f"{between(least, most)} above (19). Over rm the least max |Z1| varies by "
        f"{percent(spread)}; at 10 % from the optimum d0 max |Z1| is at most {percent(displaced)} "
        "of the free resonance."
    )


def reappearance(light, light_anywhere, light_ratio, heavy, ratio, **others):
    """Return the finding on claim 10."""
    within = "none is left in the band"
    if light != 0:
        within = f"such motions are left in the band over a range of W {number(light, 2)} wide"
    outside = ""
    if light_anywhere != 0:
        outside = (
            f", but between the folds of the free subharmonic over {number(light_anywhere, 2)} in "
            f"W, with at most {percent(light_ratio)} of its size"
        )
    return (
        "Of the stable motions whose period is a multiple of 3, with rm = 0.12 and 0.25 "
        f"{within}{outside}. With rm = 0.4 they exist in the band over {number(heavy, 2)} in W, "
        f"with at most {percent(ratio)} of the size of the free subharmonic."
    )


def restitution(band, amplitude, most, clearance, step, flat, **others):
    """Return the finding on claim 11."""
    sizes = between(amplitude, most, lambda value: number(value, 2))
    return (
        f"With e = 0.75 the band is at least {number(band, 2)} times as wide as with e = 1, and "
        f"max |Z1| in it {sizes} times as large. The optimum d0 at the lowest e is at most "
        f"{percent(clearance)} of the optimum at the highest e; from one e to the next lower one "
        f"it becomes up to {percent(step)} of its value, and the range of d0 near the optimum at "
        f"least {number(flat, 2)} times as wide."
    )


def contact_model(high, low, realised, duration, **others):
    """Return the finding on claim 15."""
    return (
        f"A wall that cannot pull would return at most {percent(high)} more than e for the e of "
        f"the figures, but {percent(low)} more for e = 0.3. In the quiet motions of figure 10 the "
        f"contacts return e to within {percent(realised)}. The paper's reason for low e, a longer "
        f"contact, is a factor of {number(duration)} at e = 0.3."
    )


def subharmonic_by_damping(low, high, fall, relative, unchanged, unchanged_high, **others):
    """Return the finding on claim 18."""
    return (
        "In the mean over random starts and W the damper lowers the amplitude of the subharmonic "
        f"by {number(low, 2)} at h = 0.107 and by {number(high, 2)} at h = 0.215; this is "
        f"{number(fall)} times as much, and {number(relative)} times relative to the free "
        "amplitude. A stable subharmonic of at least 95 % of the free amplitude remains, though "
        f"it attracts few starts, over {percent(unchanged)} of its range at h = 0.107 and over "
        f"{percent(unchanged_high)} at h = 0.215."
    )
