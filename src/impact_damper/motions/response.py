"""All motions at each frequency, and the share of random starts that lead to a collision.

A start is an initial state of oscillator and loose mass.

Z1 is the displacement of the primary mass. Multipliers are Floquet multipliers.
"""

import numpy as np

from impact_damper.data.datasets import dataset
from impact_damper.model.arguments import read_frequencies, read_radius, read_system
from impact_damper.model.bounds import (
    LIFETIME_RANGE,
    PERIODS_RANGE,
    SEED_RANGE,
    check_count,
    check_number,
)
from impact_damper.model.checks import check_starts
from impact_damper.model.names import names_arguments
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.model.settling import Settling, check_settling
from impact_damper.motions import ensemble
from impact_damper.motions.lives import find_lives
from impact_damper.motions.simulate import COMPONENTS, random_states
from impact_damper.motions.start_states import describe_search, free_motions, search_starts
from impact_damper.motions.sweep import sweep


@names_arguments
def frequency_response(
    system,
    damper,
    frequencies,
    *,
    starts=96,
    radius=None,
    seed=1995,
    settling=None,
    life_runs=0,
    life_periods=2000,
    workers=1,
    progress=None,
):
    """Find all motions at each frequency, from many starts and from neighbouring frequencies.

    Without a radius, Newton's method also looks for further stable orbits. Each
    motion found is followed to the other frequencies of its branch.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
        None: without the damper.
    frequencies : sequence of float
        Increasing forcing frequencies W, or Hz for a machine.
    starts : int
        Random starts (initial states) at each frequency.
    radius : float, optional
        Radius of a ball around rest in which random starts are uniform, with the loose mass in its
        gap; 2 in section 3 of the paper. Without this argument random starts are scaled by the
        motions without the damper, and further starts are placed on these motions.
    seed : int
        Seed of the random starts.
    settling : Settling, optional
        How long motions are run, and how accurately.
    life_runs : int
        Runs of each chaotic motion that measure how long it lasts; 0 for none.
    life_periods : int
        Length of these runs in forcing cycles.
    workers : int
        Threads; the result does not depend on it.
    progress : str, optional
        Title of a progress bar.

    Returns
    -------
    xarray.Dataset
        For each (frequency, motion) a motion: `outcome` (see `decode`), period, contacts, largest
        |Z1|, phases, multiplier, Lyapunov exponent, frequencies, branch, `motion_starts` (number of
        random starts that lead to it), the 95 % interval of their share, and the mean life of a
        chaotic motion. Motions of one branch are the same motion at different frequencies. Where a
        frequency has fewer motions than others, the outcome `absent` fills the rest. For each
        (frequency, start) outcome and length of a run; for each `end` the end of a branch; for each
        `frequency` the largest start and the largest motion without the damper. `missed_share`
        bounds, at 95 % confidence, the share of starts that lead to a motion not found.

    Raises
    ------
    ValueError
        If frequencies are not increasing, or a parameter is out of range.

    Warns
    -----
    UserWarning
        If a motion without the damper is larger or faster than the radius.

    Examples
    --------
    >>> import impact_damper as idm
    >>> bare = idm.frequency_response(idm.Oscillator(0.215), None, [1.0, 2.0], starts=8)
    >>> bare.maximum_displacement.sel(frequency=2.0).values.round(3)
    array([2.376, 0.893, 0.252])
    """
    settling = check_settling(settling)
    model = read_system(system, damper)
    frequencies = read_frequencies(model.scales, frequencies)
    check_starts(starts, len(frequencies))
    check_count("seed", seed, **SEED_RANGE)
    radius = read_radius(model.scales, radius)
    parameters = np.array([model.pack(value) for value in frequencies])
    systems = [(model.damper, value) for value in frequencies]
    search = search_starts(model.oscillator, systems, starts, radius, seed, settling)
    data = sweep(
        parameters,
        FREQUENCY,
        "frequency",
        search,
        settling,
        workers=workers,
        progress=progress,
    )
    lives = find_lives(
        parameters,
        data["outcome"][1],
        data["state"][1],
        check_count("life_runs", life_runs, least=0, most=1000),
        check_count("life_periods", life_periods, **LIFETIME_RANGE),
        seed,
        settling,
        workers=workers,
        progress=progress,
    )
    data |= {name: (("frequency", "motion"), values) for name, values in lives.items()}
    made = model.describe(settling) | describe_search(starts, radius, seed)
    made |= {"life_runs": life_runs, "life_periods": life_periods}
    coordinates = {"frequency": frequencies, "component": list(COMPONENTS)}
    return dataset(data, coordinates, made, "Frequency response", model)


def collisions(
    oscillator,
    damper,
    frequency,
    *,
    starts=2000,
    radius=None,
    seed=1995,
    periods=2000,
    tolerance=1e-9,
):
    """Count the random starts that lead to a collision, in the whole ball and within the gap.

    A start is a state in a ball around rest. Read literally, the ball of the paper extends beyond
    the walls.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
        Without a damper no start collides.
    frequency : float
        Forcing frequency W, dimensionless.
    starts : int
        Number of starts at T = 0 in each ball.
    radius : float, optional
        Radius of the ball; 2 in the paper (section 3, iii). By default the largest displacement or
        speed of the motions without the damper, whichever is larger.
    seed : int
    periods : int
        Forcing cycles of a run; only collisions within them count.
    tolerance : float
        Local error allowed in a step of the integrator.

    Returns
    -------
    xarray.Dataset
        For each `ball` (literal, within the gap): the share of starts that lie beyond a wall, the
        share that collide within the given forcing cycles, and the longest time before a first
        collision.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    p = pack(oscillator, damper, frequency)
    check_count("starts", starts, most=10**7)
    check_count("periods", periods, **PERIODS_RANGE)
    check_number("tolerance", tolerance, least=1e-15, most=1e-2)
    if radius is None:
        free = free_motions(oscillator, frequency, Settling())
        radius = max(free.displacement, free.speed) or 1.0
    shares = np.empty((2, 3))
    for row, within_gap in enumerate((False, True)):
        states = random_states(starts, radius, damper, [seed, row], within_gap=within_gap)
        waits = ensemble.collide(np.tile(p, (starts, 1)), states, periods, tolerance)
        met = np.isfinite(waits)
        shares[row] = np.mean(waits == 0), np.mean(met), np.max(waits[met], initial=0.0)
    data = dict(zip(("beyond_wall", "colliding", "longest_wait"), shares.T, strict=True))
    made = describe(oscillator, damper) | {
        "frequency": float(frequency),
        "starts": starts,
        "radius": radius,
        "seed": seed,
        "periods": periods,
    }
    return dataset(data, {"ball": ["literal", "within_gap"]}, made, "First collisions")
