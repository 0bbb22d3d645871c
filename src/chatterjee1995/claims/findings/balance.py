"""Findings on harmonic balance: claims 1 to 4, 7, 16 and 17.

Each function takes the measures of one claim as keyword arguments. The modules of the claims
(`claims.balance`, `coexistence`, `bands`, `phases`, `amplitude`) say what each measure means.
"""

from functools import partial

from chatterjee1995.claims.findings.words import between, least, number, part_of, percent

CLOSE = 1.25  # largest factor between two amplitudes that agree


def small_motion(vanishing, stable, size, orbits, orbit_size, designs, dampers, **others):
    """Return the finding on claim 1."""
    return (
        f"A root of (14) is zero at rm W^2 d0 = 1, to within {number(vanishing, 2, 'up')}. At Wp "
        f"{part_of(stable, 'designs by (19)', designs)} have a stable small solution of (7), with "
        f"at most {percent(size, 'up')} of the amplitude of the free resonance, and "
        f"{part_of(orbits, 'dampers of figures 5 and 8', dampers)} have a stable small orbit, "
        f"with at most {percent(orbit_size, 'up')}. Of these dampers omega_l is 0; claim 3 has "
        "the exact orbits for omega_l = 1 and 1.5."
    )


def rigid_against_elastic(alike, error, pulling, orbits, orbits_stable, **others):
    """Return the finding on claim 2."""
    return (
        f"At {part_of(alike, 'W computed')} equation (7) has as many solutions with contact as "
        "(14) has roots with walls that push. Apart from the smallest, their amplitudes differ by "
        f"at most {percent(error, 'up')}. At {percent(pulling)} of the W (14) also has roots "
        "whose walls would have to pull, without a counterpart in (7). For the dampers of figures "
        "5 and 8 an exact orbit whose first harmonic is within 10 % of a is known for "
        f"{percent(orbits)} of these solutions of (7); {part_of(orbits_stable, 'orbits found')} "
        "are stable."
    )


def quiet_and_high(
    around, bands, beside, designs_stable, orbit_around, single, orbits_beside, truly_stable,
    design_multiplier, design_settled, unstable_from, least_size, most_size, designs, **others,
):  # fmt: skip
    """Return the finding on claim 3."""
    at_peak = "At Wp the exact quiet orbit is stable in all these designs."
    if designs_stable != 1:
        lead = "lead to chaotic or quasi-periodic motions"
        if design_settled != 0:
            lead = f"lead to periodic motions in up to {percent(design_settled)} of the cases"
        at_peak = (
            "At Wp the exact quiet orbit is unstable in "
            f"{part_of(1 - designs_stable, 'designs', designs)}, all with omega_l of at least "
            f"{number(unstable_from)}, with Floquet multipliers up to "
            f"{number(design_multiplier, 3, 'up')}; there random starts {lead}, with max |Z1| "
            f"from {between(least_size, most_size).replace(' to ', ' % to ')} of the free "
            "resonance."
        )
    approximated = part_of(
        truly_stable,
        "symmetric orbits with two contacts that the violent solutions of (7) approximate",
    )
    return (
        f"By (7) {part_of(bands, 'designs of figure 3', designs)} have a suppression band, a "
        f"stable quiet solution at {least(around)} of the W within 10 % of Wp, and a stable "
        f"violent one at {least(beside)} of the W below the band. {at_peak} For omega_l = 0 "
        f"stable quiet orbits fill {least(orbit_around)} of the range within 10 % of Wp; at a W "
        f"in the band {least(single)} of the random starts lead to one, the others to motions "
        f"that are not violent. Below the band stable violent orbits fill {least(orbits_beside)} "
        f"of the range, but {approximated} are stable."
    )


def band_width(
    linear_rule, linear, relative_rule, relative, mass, existing, restitution,
    reduction, reduction_rule, orbit_reduction, orbit_reduction_rule, designs_stable, **others,
):  # fmt: skip
    """Return the finding on claim 4."""
    missing = ""
    if designs_stable != 1:
        missing = (
            f" But {percent(1 - designs_stable)} of these orbits are unstable at Wp, and larger "
            "motions take their place (claim 3), so that the reduction then does depend on omega_l."
        )
    narrower = ""
    if relative < 1:
        narrower = "; with these the band becomes narrower relative to Wp in at least one step"
    return (
        "By (7) each step to a larger omega_l multiplies the width of the band by at least "
        f"{number(linear_rule, 3, 'down')} with d0 by (19) and by at least "
        f"{number(linear, 4, 'down')} with d0 of the captions. It multiplies the width over Wp by "
        f"at least {number(relative_rule, 3, 'down')} with d0 by (19) and "
        f"{number(relative, 3, 'down')} with d0 of the captions{narrower}. Each step to a larger "
        f"rm multiplies the width by at least {number(mass, 3, 'down')} by (7), and by at least "
        f"{number(existing, 3, 'down')} in the motions that exist; there the step from e = 1 to "
        f"0.75 multiplies it by at least {number(restitution, 3, 'down')}. The reduction at Wp "
        f"varies over omega_l by {number(reduction_rule, 2)} percentage points with d0 by (19) "
        f"and by {number(reduction, 2)} with d0 of the captions; for the exact quiet orbits, "
        f"stable or not, by {number(orbit_reduction_rule, 2)} and {number(orbit_reduction, 2)} "
        f"percentage points.{missing}"
    )


def phases(
    below, above, highest, turn_balance, turn, in_phase, loose_below, loose_above, **others,
):  # fmt: skip
    """Return the finding on claim 7."""
    return (
        "Read literally, for the displacements of both masses, the claim is reversed: Z1 and the "
        f"displacement x2 of the loose mass are within {number(loose_below, 2, 'up')} rad of "
        f"being in phase below Wp, and within {number(loose_above, 2, 'up')} rad of antiphase at "
        f"the highest W computed, {number(highest)}. Read as in (6d), with Z2 for the loose mass, "
        "it holds: from 0.75 Wp to Wp the first harmonics of Z1 and Z2 are within "
        f"{number(below, 2, 'up')} rad of antiphase. They are a quarter of a cycle apart at "
        f"{number(turn)} Wp, whereas by (7) a changes sign at {number(turn_balance)} Wp, and "
        f"within 0.3 rad of being in phase from {number(in_phase)} Wp on. At the highest W "
        f"{number(above, 2, 'up')} rad are left."
    )


def accuracy(typical, width, typical_factor, factor, least_factor, harmonic, share, **others):
    """Return the finding on claim 16."""
    agrees = "agrees" if factor <= CLOSE else "does not agree"
    return (
        f"Harmonic balance gives the width of the band to {percent(typical)} in the median over "
        f"the dampers, and to {percent(width, 'up')} at worst. The amplitude {agrees}: depending "
        "on the damper, the mean of max |Z1| over the band is "
        f"{between(least_factor, factor, partial(number, digits=2))} times the mean of |a|, in "
        f"the median {number(typical_factor, 2)} times. The mean of the first harmonic differs "
        f"from that of |a| by a factor of up to {number(harmonic, 2, 'up')}. Max |Z1| and |a| "
        f"differ by at most {percent(share, 'up')} of the free resonance."
    )


def amplitude_by_mass(
    whole, steps, rule, product_a, product_b, product_c, lightest, heaviest, rule_lightest,
    rule_heaviest, balance, frequency, **others,
):  # fmt: skip
    """Return the finding on claim 17."""
    return (
        f"At rm = {number(heaviest)} the mean of max |Z1| over the common band of the dampers of "
        f"figure 5 is {percent(whole)} of the mean at rm = {number(lightest)}. Each step to a "
        f"larger rm multiplies the mean by at most {number(steps, 3, 'up')}, by (7) by at most "
        f"{number(balance, 3, 'up')}. At W = {number(frequency)}, the design frequency of the "
        f"paper, rm W^2 d0 is {number(product_a)} in (a), {number(product_b)} in (b) and "
        f"{number(product_c)} in (c), whereas (19) demands 1. For dampers that fulfil (19) max "
        f"|Z1| at this W and at rm = {number(rule_heaviest)} is {percent(rule)} of its value at "
        f"rm = {number(rule_lightest)}."
    )
