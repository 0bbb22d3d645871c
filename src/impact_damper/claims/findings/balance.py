"""Findings on harmonic balance: claims 1 to 4, 7, 16 and 17."""

from impact_damper.claims.findings.words import least, number, part_of, percent


def small_motion(vanishing, stable, size, orbits, orbit_size, designs, dampers, **others):
    """Return the finding on claim 1."""
    return (
        f"A root of (14) is zero at rm W^2 d0 = 1, to within {number(vanishing, 1)}. At Wp "
        f"{part_of(stable, 'designs by (19)', designs)} have a stable small solution of (7), with "
        f"at most {percent(size)} of the amplitude of the free resonance, and "
        f"{part_of(orbits, 'dampers of figures 5 and 8', dampers)} have a stable small orbit, "
        f"with at most {percent(orbit_size)}; of these dampers omega_l is 0."
    )


def rigid_against_elastic(alike, error, orbits, **others):
    """Return the finding on claim 2."""
    return (
        "Equations (14) and (7) have the same number of solutions at "
        f"{part_of(alike, 'frequencies')}, and their larger solutions differ by at most "
        f"{percent(error)}. On the branches of exact orbits computed there is an orbit whose "
        f"amplitude differs by at most 10 % for {percent(orbits)} of the larger solutions of (7)."
    )


def quiet_and_high(
    reach, bands, beside, orbit_reach, orbits_beside, designs_stable, design_multiplier,
    design_damping, designs, **others,
):  # fmt: skip
    """Return the finding on claim 3."""
    exact = "At Wp the exact quiet orbit is stable in all designs of figure 3."
    if designs_stable != 1:
        exact = (
            "At Wp the exact quiet orbit is unstable in "
            f"{part_of(1 - designs_stable, 'designs of figure 3', designs)}, with Floquet "
            f"multipliers up to {number(design_multiplier)}; it is stable in all designs only "
            f"above h = {number(design_damping, 2)}."
        )
    return (
        f"{exact} By (7) {part_of(bands, 'designs')} have a suppression band, a stable quiet "
        f"solution everywhere within {percent(reach)} of Wp, and below the band a stable violent "
        f"solution at {least(beside)} of the frequencies. For omega_l = 0 quiet orbits are stable "
        f"within {percent(orbit_reach)} of Wp, and stable violent ones fill "
        f"{least(orbits_beside)} of the range below the band."
    )


def band_width(linear, linear_rule, mass, existing, restitution, reduction, **others):
    """Return the finding on claim 4."""
    return (
        f"By harmonic balance each step to a larger omega_l multiplies the width of the band by at "
        f"least {number(linear)} with the clearances of the captions and by {number(linear_rule)} "
        f"with those of (19); each step to a larger rm multiplies it by at least {number(mass)}. "
        f"In the simulated motions each step in rm multiplies it by at least {number(existing)}, "
        f"and the step from e = 1 to 0.75 by {number(restitution)}. The relative reduction of "
        f"the amplitude at Wp varies over omega_l by {number(reduction, 2)}."
    )


def phases(below, above, turn_balance, turn, loose_below, loose_above, **others):
    """Return the finding on claim 7."""
    return (
        f"The first harmonics of Z1 and Z2 are within {number(below, 2)} rad of antiphase below "
        f"Wp, and within {number(above, 2)} rad of being in phase at the highest W; the change "
        f"comes at {number(turn)} Wp, by harmonic balance at {number(turn_balance)} Wp. Z1 and the "
        "displacement x2 of the loose mass do the opposite: they are within "
        f"{number(loose_below, 2)} rad of being in phase below Wp, and within "
        f"{number(loose_above, 2)} rad of antiphase at the highest W."
    )


def accuracy(typical, width, share, ratio, harmonic, **others):
    """Return the finding on claim 16."""
    joint = "but not relative to |a|" if ratio > 1.25 else "and relative to |a|"
    return (
        f"Harmonic balance gives the width of the band to {percent(typical)} in the median over "
        f"the dampers and to {percent(width)} at worst. It gives the amplitude in the band to "
        f"{percent(share)} of the free resonance, {joint}: max |Z1| is up to {number(ratio, 2)} "
        f"times as large, and its first harmonic up to {number(harmonic, 2)} times."
    )


def amplitude_by_mass(whole, steps, balance, **others):
    """Return the finding on claim 17."""
    return (
        f"In the bands the mean of max |Z1| at the largest rm is {percent(whole)} of the mean at "
        f"the smallest. At each step to a larger rm it falls to at most {percent(steps)} of its "
        f"previous value, by harmonic balance to at most {percent(balance)}."
    )
