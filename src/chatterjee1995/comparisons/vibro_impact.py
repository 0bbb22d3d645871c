"""The slow invariant manifold of the vibro-impact absorber, compared with orbits and decays.

The slow invariant manifold is the relation between the amplitude of the primary mass and the speed
of a loose mass that meets each wall once in a cycle. Its closed forms
(`literature.slow_invariant_manifold`) hold for a small mass ratio rm. The speed w of the loose mass
is stated as the ratio t = pi w/(2 W d0), with the forcing frequency W and the clearance d0. The
computed numbers come from orbits and simulations with finite rm.

Z2 is the displacement of the primary mass relative to the loose mass.
"""

import numpy as np
from scipy.optimize import minimize_scalar

from chatterjee1995.comparisons.comparison import Comparison, observed_order
from chatterjee1995.comparisons.masri_caughey_stability import stability_boundaries
from chatterjee1995.comparisons.symmetric_orbits import boundary_near, orbit_with_speed
from impact_damper.model.checks import check_increasing
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.simulate import simulate
from impact_damper.theory.slow_invariant_manifold import VibroImpactAbsorber

# Speed ratios t in an unforced decay. The simulation begins at START. Between START and FIRST a few
# impacts bring the motion to the manifold. The time from t = FIRST to t = LAST is measured.
START, FIRST, LAST = 1.6, 1.5, 1.1
# Damping h of the oscillator in an unforced decay, the smallest that `Oscillator` allows; 0 is not
# allowed.
UNDAMPED = 1e-9
# SAMPLES: number of stored states in each natural period of a simulated decay. LONGER: length of
# the simulation divided by the predicted time of the decay from START to LAST.
SAMPLES, LONGER = 24, 1.2
# Distance to the wall Z2 = -d0 at the beginning of a decay, with d0 = 1.
APART = 1e-9


def vibro_impact(restitution, damping_share, mass_ratios, contact_stiffness):
    """Compare thresholds of the force, speeds at the ends of the manifold, and the best clearance.

    The thresholds are the extreme values of the force along the stable part of the manifold.

    Parameters
    ----------
    restitution : float
        e.
    damping_share : float
        Damping ratio of the oscillator divided by rm.
    mass_ratios : sequence of float
        Two or more values of rm in descending order. The order of convergence is estimated from
        each pair of neighbouring values.
    contact_stiffness : float
        Contact stiffness r1 of the computed orbits. It must be so large that the difference caused
        by finite r1 is small compared with the difference caused by finite rm.

    Returns
    -------
    list of Comparison

    Raises
    ------
    ArithmeticError
        If an orbit is not found.
    """
    words = f"e = {restitution:g}, damping ratio {damping_share:g} rm"
    rows = [
        _thresholds(restitution, damping_share, mass, contact_stiffness) for mass in mass_ratios
    ]
    return _series(rows, mass_ratios, words)


def ring_down(restitution, mass_ratios, contact_stiffness):
    """Compare the time in which the speed ratio t falls from FIRST to LAST in an unforced decay.

    Parameters
    ----------
    restitution, mass_ratios, contact_stiffness
        As in `vibro_impact`.

    Returns
    -------
    list of Comparison
    """
    rows = []
    for mass in mass_ratios:
        absorber = VibroImpactAbsorber(mass, restitution)
        ours = decay_time(absorber, contact_stiffness)
        rows.append({"time of ring-down": (absorber.ring_down_time(FIRST, LAST), ours)})
    return _series(rows, mass_ratios, f"t from {FIRST:g} to {LAST:g}, e = {restitution:g}")


def _series(rows, mass_ratios, words):
    """Return comparisons of each quantity at each mass ratio, with the order of convergence.

    `rows` has a dictionary for each mass ratio, which maps each quantity to a pair: the value of
    the closed form and the computed number. `words` names the other parameters.

    Raises
    ------
    ValueError
        If the mass ratios do not decrease, or if there are fewer than two.
    """
    check_increasing("mass_ratios, from the last on", mass_ratios[::-1], "two")
    comparisons = []
    for quantity in rows[0]:
        values = np.array([row[quantity] for row in rows])
        differences = values[:, 1] / values[:, 0] - 1
        for k, (mass, (published, ours)) in enumerate(zip(mass_ratios, values, strict=True)):
            order = np.nan
            if k:
                pair = slice(k - 1, k + 1)
                order = observed_order(mass_ratios[pair], differences[pair])
            comparisons.append(
                Comparison(
                    "slow_manifold",
                    f"{quantity}, rm = {mass:g}, {words}",
                    float(published),
                    float(ours),
                    "mass_ratio",
                    order=order,
                    expected=mass,
                )
            )
    return comparisons


def _thresholds(restitution, damping_share, mass, contact_stiffness):
    """Return a dictionary from quantity to (closed form, computed number) for a mass ratio."""
    absorber = VibroImpactAbsorber(mass, restitution, damping_share * mass)
    oscillator = Oscillator(2 * absorber.damping_ratio, 1.0, cubic=0.0, force=1.0)
    damper = Damper(mass, 1.0, restitution, contact_stiffness)
    pairs = {}
    for name, end, threshold in (
        ("activation", 0, absorber.activation()),
        ("upper threshold", -1, absorber.upper_threshold()),
    ):
        if threshold.ratio in absorber.stable_ratios:
            boundary = stability_boundaries(oscillator, damper, threshold.frequency)[end]
            ours = boundary_near(oscillator, damper, threshold.frequency, boundary)
            ratio = np.pi * ours.ratio / (2 * threshold.frequency)
            pairs[f"speed at the {name}"] = threshold.ratio, ratio
        else:
            speed = 2 * threshold.frequency / np.pi * threshold.ratio
            ours = orbit_with_speed(oscillator, damper, threshold.frequency, speed)
        pairs[f"force of {name} over stiffness times half the gap"] = (
            threshold.force,
            1 / ours.clearance,
        )
    best = minimize_scalar(
        lambda ratio: orbit_with_speed(oscillator, damper, 1.0, ratio).displacement,
        bounds=(1.6 / np.pi, 2.4 / np.pi),
        method="bounded",
        options={"xatol": 1e-6},
    )
    ours = orbit_with_speed(oscillator, damper, 1.0, best.x)
    optimum = absorber.optimum()
    pairs["optimum half gap over static deflection"] = optimum.clearance, ours.clearance
    pairs["amplitude there over static deflection"] = optimum.amplitude, ours.displacement
    return pairs


def decay_time(absorber, contact_stiffness) -> float:
    """Return the time in which t falls from FIRST to LAST, from a simulated unforced decay.

    The manifold gives the amplitudes of the primary mass at t = FIRST and t = LAST. Between
    contacts the amplitude is constant, because the primary mass is undamped. The amplitude at a
    contact is defined as the mean of the amplitudes before and after the contact.

    Parameters
    ----------
    absorber : VibroImpactAbsorber
        Its damping ratio is not used.
    contact_stiffness : float
        r1 of the simulation.
    """
    mass, restitution = absorber.mass_ratio, absorber.restitution
    periods = LONGER * absorber.ring_down_time(START, LAST) / (2 * np.pi)
    speed = 2 * START / np.pi
    after = (2 * mass - (1 - restitution) / (1 + restitution)) * speed
    motion = simulate(
        Oscillator(UNDAMPED, 1.0, cubic=0.0, force=0.0),
        Damper(mass, 1.0, restitution, contact_stiffness),
        1.0,
        (START - 1, after, APART - 1, after + speed),
        periods=periods,
        samples=SAMPLES,
    )
    contacts = (motion["contact_begin"].values + motion["contact_end"].values) / 2
    contacts = contacts[np.isfinite(contacts)]
    size = np.hypot(motion["displacement"].values, motion["velocity"].values)
    flights = np.interp((contacts[1:] + contacts[:-1]) / 2, motion["time"].values, size)
    sizes = (flights[1:] + flights[:-1]) / 2
    wanted = absorber.amplitude(np.array([FIRST, LAST]))
    first, last = np.interp(-wanted, -sizes, contacts[1:-1])
    return float(last - first)
