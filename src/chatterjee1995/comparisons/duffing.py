"""Comparisons for the oscillator without a damper: published basin shares, jumps of the response.

The share of a motion is the fraction of random initial states that lead to it. On a curve of
amplitude over frequency, a motion ends at a fold, where the curve turns back. A slow sweep of the
frequency then jumps to another motion.

W T is the phase of the forcing.
"""

import numpy as np

from chatterjee1995.comparisons import basin_shares as published
from chatterjee1995.comparisons.comparison import Comparison
from chatterjee1995.comparisons.duffing_jumps import jumps
from impact_damper.data.datasets import is_settled
from impact_damper.model.bounds import MOST_RUNS, check_count
from impact_damper.model.families import family_of
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Oscillator
from impact_damper.motions.ensemble import settle
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit

# A settled state belongs to an orbit if it differs by at most SAME from a state of the orbit.
SAME = 1e-3
# Range of forcing frequencies, divided by the natural frequency, over which periodic motions are
# followed.
SPAN = 0.6, 1.4


def basin_shares(starts, seed, settling):
    """Compare the shares of random starts that lead to five motions with those published by bSTAB.

    bSTAB is a program that computes basins (`literature.basin_shares`).

    Parameters
    ----------
    starts : int
        Number of starts, drawn uniformly from the published box.
    seed : int
    settling : Settling

    Returns
    -------
    list of Comparison
        One for each motion, with the standard error of the difference of the two shares.

    Raises
    ------
    ArithmeticError
        If a start does not lead to one of the five motions.
    """
    check_count("starts", starts, most=MOST_RUNS)
    oscillator = Oscillator(published.DAMPING, 0.0, force=published.FORCE)
    p = pack(oscillator, None, published.FREQUENCY)
    generator = np.random.default_rng(seed)
    drawn = np.column_stack([generator.uniform(*span, starts) for span in published.BOX])
    known = np.array([motion.start for motion in published.MOTIONS])
    states = np.tile(np.concatenate([known, drawn]), 2)
    records = settle(np.tile(p, (len(states), 1)), states, settling)
    if not is_settled(records).all():
        raise ArithmeticError("basin shares: some motions have not settled")
    count = len(known)
    orbits = [
        find_orbit(p, each["state"], int(each["period"])).strobe_states[:, :2]
        for each in records[:count]
    ]
    ends = records["state"][count:, None, :2]
    distance = np.array([np.abs(ends - orbit).max(axis=2).min(axis=1) for orbit in orbits])
    if distance.min(axis=0).max() > SAME:
        raise ArithmeticError("basin shares: some starts lead to none of the five motions")
    shares = np.bincount(distance.argmin(axis=0), minlength=count) / starts
    comparisons = []
    for motion, share in zip(published.MOTIONS, shares, strict=True):
        variance = motion.share * (1 - motion.share) * (1 / starts + 1 / published.STARTS)
        comparisons.append(
            Comparison(
                "bstab",
                f"basin share of the {motion.meaning} ({motion.name}), {starts} starts",
                motion.share,
                float(share),
                "random_starts",
                error=float(np.sqrt(variance)),
                expected=float(1.96 * np.sqrt(variance) / motion.share),
            )
        )
    return comparisons


def jump_frequencies(springs, damping_ratios, peak):
    """Compare closed-form jump frequencies with the folds of branches of computed orbits.

    A branch is the curve of the periodic orbits over the frequency.

    Parameters
    ----------
    springs : sequence of float
        Cubic coefficients, negative for softening springs.
    damping_ratios : sequence of float
        Damping ratios z in descending order.
    peak : float
        Ratio of the force to the damping ratio. The amplitude at the peak is about half this ratio.

    Returns
    -------
    list of Comparison

    Raises
    ------
    ArithmeticError
        If a branch does not have exactly two folds.
    """
    comparisons = []
    for cubic in springs:
        for damping in damping_ratios:
            force = peak * damping
            closed, exact = jumps(damping, cubic, force), _folds(damping, cubic, force)
            kind = "softening" if cubic < 0 else "hardening"
            words = f"{kind} spring {cubic:g}, damping ratio {damping:g}, force {force:g}"
            for name, published_value, ours in (
                ("from the large motion", closed.down, exact[0]),
                ("from the small motion", closed.up, exact[1]),
            ):
                comparisons.append(
                    Comparison(
                        "brennan", f"jump {name}, {words}", published_value, ours, "one_harmonic"
                    )
                )
    return comparisons


def _folds(damping_ratio, cubic, force):
    """Return the frequencies at which the large and the small motion end, in this order."""
    oscillator = Oscillator(2 * damping_ratio, 1.0, cubic=cubic, force=force)
    begin = SPAN[0]
    # The first guess is the linear response without damping, well below resonance, at W T = pi/2.
    speed = -begin * force / (1 - begin**2)
    orbit = find_orbit(pack(oscillator, None, begin), [0.0, speed, 0.0, speed])
    family, coordinate, ends = family_of(oscillator, None, begin, "frequency", SPAN)
    branch = follow_branch(family, orbit, coordinate, ends)
    folds = [event.point for _, event in branch.events if event.kind == "fold"]
    if len(folds) != 2:
        raise ArithmeticError(f"cubic = {cubic:g}: {len(folds)} folds in place of two")
    folds.sort(key=lambda point: -point.orbit.record["maximum_displacement"])
    return [float(point.value) for point in folds]
