"""Findings on harmonic balance: claims 1 to 4, 7, 16 and 17."""

from impact_damper.claims.findings.words import number, part_of, percent, widening


def small_motion(vanishing, stable, size, orbits, orbit_size, **others):
    """Return the finding on claim 1."""
    return (
        "A root of (14) is zero where rm W^2 d0 differs from 1 by no more than "
        f"{number(vanishing, 1)}. At Wp {part_of(stable, 'the designs by (19)')} have a stable "
        f"small solution of (7), with at most {percent(size)} of the free resonance, and "
        f"{part_of(orbits, 'the dampers of figures 5 and 8')} have a stable small orbit, with at "
        f"most {percent(orbit_size)}."
    )


def rigid_against_elastic(alike, error, orbits, **others):
    """Return the finding on claim 2."""
    return (
        f"Equations (14) and (7) have equally many solutions at {percent(alike)} of the "
        f"frequencies, where their larger solutions differ by at most {percent(error)}. For "
        f"{percent(orbits)} of the larger solutions of (7) there is an exact orbit whose "
        "amplitude differs by less than 10 %."
    )


def quiet_and_high(
    reach, bands, beside, orbit_reach, orbits_beside, designs_stable, design_multiplier,
    design_damping, **others,
):  # fmt: skip
    """Return the finding on claim 3."""
    exact = "The exact quiet orbit at Wp is stable in all designs of figure 3."
    if designs_stable != 1:
        exact = (
            "But the exact quiet orbit at Wp is stable in "
            f"{part_of(designs_stable, 'the designs')} only, since Floquet multipliers reach "
            f"{number(design_multiplier)}; it is stable in all of them only for h above "
            f"{number(design_damping, 2)}."
        )
    return (
        f"By (7), {part_of(bands, 'the designs of figure 3')} have a suppression band, a stable "
        f"low solution everywhere within {percent(reach)} of Wp, and below the band a stable high "
        f"one at {percent(beside)} of the frequencies or more. For omega_l = 0 exact orbits "
        f"agree: low ones are stable within {percent(orbit_reach)} of Wp, high ones over "
        f"{percent(orbits_beside)} of the range below the band or more. {exact}"
    )


def band_width(linear, linear_rule, mass, existing, restitution, reduction, **others):
    """Return the finding on claim 4."""
    return (
        f"By harmonic balance the band {widening(linear)} from each omega_l to the next larger "
        f"one with the clearances of the captions, {widening(linear_rule)} with those of (19), "
        f"and {widening(mass)} from each rm to the next larger one. In the motions that exist it "
        f"{widening(existing)} from each rm to the next, and {widening(restitution)} from e = 1 "
        f"to 0.75. Over omega_l the reduction at Wp varies by {percent(reduction)} of the free "
        "resonance."
    )


def phases(below, above, turn_balance, turn, loose_below, loose_above, **others):
    """Return the finding on claim 7."""
    return (
        f"The first harmonics of Z1 and Z2 are in antiphase to {number(below, 2)} rad below Wp "
        f"and in phase to {number(above, 2)} rad at the highest W. The phase turns at "
        f"{number(turn)} Wp, by harmonic balance at {number(turn_balance)} Wp. For the "
        "displacement x2 of the loose mass itself the opposite is true: in phase with Z1 to "
        f"{number(loose_below, 2)} rad below Wp, in antiphase to {number(loose_above, 2)} rad at "
        "the highest W."
    )


def accuracy(typical, width, share, ratio, harmonic, **others):
    """Return the finding on claim 16."""
    return (
        "The width of the band by harmonic balance differs from the width by the motions that "
        f"exist by {percent(typical)} in the median and {percent(width)} at most. In the band |a| "
        f"and max |Z1| differ by at most {percent(share)} of the free resonance; relative to |a|, "
        f"though, max |Z1| is up to {number(ratio, 2)} times as large, and its first harmonic up "
        f"to {number(harmonic, 2)} times."
    )


def amplitude_by_mass(whole, steps, balance, **others):
    """Return the finding on claim 17."""
    return (
        f"In the bands the mean max |Z1| at the largest rm is {percent(whole)} of the mean at the "
        f"smallest rm. From one rm to the next larger one it becomes at most {percent(steps)} of "
        f"its value; by harmonic balance at most {percent(balance)}."
    )
