"""The slow invariant manifold of the vibro-impact absorber, compared with our orbits and decays.

The closed forms are those of `literature.slow_invariant_manifold`, of first order in the mass ratio
rm. t = pi w/(2 W d0) is the speed w of the loose mass as a ratio, with the forcing frequency W and
the clearance d0 (half the gap). Our numbers come from orbits and simulations with finite rm.
"""

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.comparisons.comparison import Comparison, observed_order
from impact_damper.comparisons.symmetric_orbits import boundary_near, orbit_with_speed
from impact_damper.literature.masri_caughey_stability import stability_boundaries
from impact_damper.literature.slow_invariant_manifold import VibroImpactAbsorber
from impact_damper.motions.simulate import simulate
from impact_damper.system.checks import check_increasing
from impact_damper.system.parameters import Damper, Oscillator

# Speed ratios t in a free decay. The simulation begins at START; the time is taken from t = FIRST
# to t = LAST. Between START and FIRST a few impacts bring the motion to the manifold.
START, FIRST, LAST = 1.6, 1.5, 1.1
# Damping h of the oscillator in a free decay: the least that `Oscillator` allows, since 0 is not.
UNDAMPED = 1e-9
# SAMPLES: stored states in each natural period of a simulated decay. LONGER: ratio of the length of
# this simulation to the predicted time of the decay from START to LAST.
SAMPLES, LONGER = 24, 1.2
# Distance of the loose mass from the wall Z2 = -d0 at the start of a decay, where d0 = 1.
APART = 1e-9


def vibro_impact(restitution, damping_share, mass_ratios, contact_stiffness):
    """Compare thresholds of the force, ends of the manifold and the optimum clearance.

    Parameters
    ----------
    restitution : float
        e.
    damping_share : float
        Damping ratio of the oscillator divided by rm.
    mass_ratios : sequence of float
        Falling rm, two or more. The order of convergence is estimated from each pair of
        neighbouring ones.
    contact_stiffness : float
        r1 of our orbits, so large that the error by finite r1 is small against that by finite rm.

    Returns
    -------
    list of Comparison

    Raises
    ------
    ArithmeticError
        If our orbits are not found.
    """
    words = f"e = {restitution:g}, damping ratio {damping_share:g} rm"
    rows = [
        _thresholds(restitution, damping_share, mass, contact_stiffness) for mass in mass_ratios
    ]
    return _series(rows, mass_ratios, words)


def ring_down(restitution, mass_ratios, contact_stiffness):
    """Compare the time in which the speed ratio t falls from FIRST to LAST in a free decay.

    Parameters
    ----------
    restitution, mass_ratios, contact_stiffness
        As of `vibro_impact`.

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

    `rows` has a dictionary for each mass ratio: its keys are the quantities, its values pairs of
    the number of the closed form and our number.

    Raises
    ------
    ValueError
        If the mass ratios do not fall, or are fewer than two.
    """
    check_increasing("mass_ratios, from the last on", mass_ratios[::-1], "two")
    found = []
    for quantity in rows[0]:
        values = np.array([row[quantity] for row in rows])
        differences = values[:, 1] / values[:, 0] - 1
        for k, (mass, (published, ours)) in enumerate(zip(mass_ratios, values, strict=True)):
            order = np.nan
            if k:
                pair = slice(k - 1, k + 1)
                order = observed_order(mass_ratios[pair], differences[pair])
            found.append(
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
    return found


def _thresholds(restitution, damping_share, mass, contact_stiffness):
    """Return a dictionary for one mass ratio: quantity -> (closed form's number, our number)."""
    absorber = VibroImpactAbsorber(mass, restitution, damping_share * mass)
    oscillator = Oscillator(2 * absorber.damping_ratio, 1.0, cubic=0.0, force=1.0)
    damper = Damper(mass, 1.0, restitution, contact_stiffness)
    found = {}
    for name, end, threshold in (
        ("activation", 0, absorber.activation()),
        ("upper threshold", -1, absorber.upper_threshold()),
    ):
        if threshold.ratio in absorber.stable_ratios:
            boundary = stability_boundaries(oscillator, damper, threshold.frequency)[end]
            ours = boundary_near(oscillator, damper, threshold.frequency, boundary)
            ratio = np.pi * ours.ratio / (2 * threshold.frequency)
            found[f"speed at the {name}"] = threshold.ratio, ratio
        else:
            speed = 2 * threshold.frequency / np.pi * threshold.ratio
            ours = orbit_with_speed(oscillator, damper, threshold.frequency, speed)
        found[f"force of {name} over stiffness times half the gap"] = (
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
    found["optimum half gap over static deflection"] = optimum.clearance, ours.clearance
    found["amplitude there over static deflection"] = optimum.amplitude, ours.displacement
    return found


def decay_time(absorber, contact_stiffness) -> float:
    """Return the time in which t falls from FIRST to LAST, from a simulated free decay.

    The amplitude of the undamped primary mass is constant between contacts; the amplitude at a
    contact is taken as the mean of those before and after it. The manifold gives the amplitudes
    that belong to FIRST and LAST.

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
