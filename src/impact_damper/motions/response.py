"""All motions at each frequency, and lives of chaotic transients.

The life of a chaotic transient is its duration. Lives are distributed exponentially. So the number
of transients that end, divided by the sum of all lives, estimates the rate at which transients end.
"""

from dataclasses import replace

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.data.shares import escape_rate
from impact_damper.model import bounds
from impact_damper.model.arguments import read_frequencies, read_radius, read_system
from impact_damper.model.packed import FREQUENCY
from impact_damper.model.settling import check_settling
from impact_damper.motions import ensemble
from impact_damper.motions.ensemble import settle_many
from impact_damper.motions.records import CHAOTIC, MOTION, UNRESOLVED
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.motions.start_states import describe_search, search_starts
from impact_damper.motions.steady import run_chunks
from impact_damper.motions.sweep import sweep
from impact_damper.motions.watch import NEAR

# Runs that measure the lives (durations) of chaotic transients. APART: largest random change of Z1
# and of Z1' in the first state. CAPTURE: distance from an orbit at which a transient has ended.
# CHECKED: number of further cycles for which a run is continued if its transient has not ended.
APART, CAPTURE, CHECKED = 1e-4, 0.1, 300


@bounds.names_arguments
def frequency_response(
    system,
    damper,
    frequencies,
    *,
    starts=96,
    radius=None,
    whole_gap=False,
    seed=1995,
    settling=None,
    life_runs=0,
    life_periods=2000,
    workers=1,
    progress=None,
):
    """Find all motions at each frequency, from many starts and from neighbouring frequencies.

    Without a radius, Newton's method also looks for further stable orbits. Each motion found is
    followed to neighbouring frequencies, as far as the branch of the motion extends.

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
        Random starts are uniform in a ball with this radius around rest, and the loose mass is in
        its gap. Without a radius, displacements and speeds of the primary mass in random starts
        reach up to three times their largest values without the damper. There are then also starts
        that are not random, for example states on motions without the damper.
    whole_gap : bool
        Used with a radius. If False, all four components of a start lie in the ball, as in the
        paper. If True, only Z1 and Z1' lie in the ball; the loose mass is at relative rest anywhere
        in its gap. With `radius=0` and `whole_gap=True` the machine starts from rest.
    seed : int
        Seed of the random starts.
    settling : Settling, optional
    life_runs : int
        Number of runs in which the life of each chaotic motion is measured. 0: no measurement.
    life_periods : int
        Largest length of such a run, in forcing cycles. A life is the duration of a chaotic motion.
    workers : int
        Number of threads. The result does not depend on this number.
    progress : str, optional
        Title of a progress bar.

    Returns
    -------
    xarray.Dataset
        - For each (frequency, motion): the variables of `steady_motion`; the index of the branch;
          `motion_starts`, the number of random starts that lead to the motion; the 95 % interval of
          the share of random starts that lead to the motion; the mean life of a chaotic motion.
          Entries without a motion have the outcome `absent`.
        - For each (frequency, start): outcome and length of the run. For each `end`: where and how
          a branch ends. For each `frequency`: the largest |Z1| and the largest speed of the primary
          mass, both in random starts and in motions without the damper.
        - `missed_share`: upper bound (95 %) on the share of starts that lead to motions not found.

    Warns
    -----
    UserWarning
        If |Z1| or the speed without the damper exceeds the radius, unless `whole_gap` is True.

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
    bounds.check_starts(starts, len(frequencies))
    bounds.check_count("seed", seed, **bounds.SEED_RANGE)
    radius = read_radius(model.scales, radius, whole_gap)
    parameters = np.array([model.pack(value) for value in frequencies])
    systems = [(model.damper, value) for value in frequencies]
    drawn = starts, radius, seed
    search = search_starts(model.oscillator, systems, *drawn, settling, whole_gap=whole_gap)
    runs = bounds.check_count("life_runs", life_runs, least=0, most=1000)
    cycles = bounds.check_count("life_periods", life_periods, **bounds.LIFETIME_RANGE)
    running = {"workers": workers, "progress": progress}
    data = sweep(parameters, FREQUENCY, "frequency", search, settling, **running)
    found = data["outcome"][1], data["state"][1]
    lives = find_lives(parameters, *found, runs, cycles, seed, settling, **running)
    data |= {name: (("frequency", "motion"), values) for name, values in lives.items()}
    made = model.describe(settling) | describe_search(*drawn, whole_gap)
    made |= {"life_runs": life_runs, "life_periods": life_periods}
    coordinates = {"frequency": frequencies, "component": list(COMPONENTS)}
    return dataset(data, coordinates, made, "Frequency response", model)


def find_lives(parameters, outcomes, states, runs, periods, seed, settling, **running) -> dict:
    """Measure the mean lives of the chaotic motions in a sweep; return dataset variables (n, m).

    Each chaotic motion is run `runs` times for at most `periods` cycles, from random states nearby.
    `outcomes` (n, m), `states` (n, m, 4): all motions. `running` holds `workers` and `progress`.
    """
    chaotic = np.argwhere(outcomes == flag("outcome", "chaotic"))
    table = {"life_ends": np.full(outcomes.shape, -1)}
    for name in ("mean_life", "mean_life_lower", "mean_life_upper"):
        table[name] = np.full(outcomes.shape, np.nan)
    if len(chaotic) == 0 or runs == 0:
        return table
    rows = np.repeat(parameters[chaotic[:, 0]], runs, axis=0)
    starts = np.repeat(states[tuple(chaotic.T)], runs, axis=0)
    starts[:, :2] += np.random.default_rng([seed, runs]).uniform(-APART, APART, (len(starts), 2))
    lives = _lives(rows, starts, periods, settling, **running).reshape(-1, runs)
    for place, own in zip(map(tuple, chaotic), lives, strict=True):
        rate, lower, upper = escape_rate(own, periods)
        table["life_ends"][place] = np.sum(own <= periods)
        table["mean_life"][place] = 1 / rate if rate > 0 else np.nan
        table["mean_life_lower"][place] = 1 / upper
        table["mean_life_upper"][place] = 1 / lower if lower > 0 else np.inf
    return table


def _lives(parameters, states, periods, settling, **running):
    records, stop = np.zeros(len(states), MOTION), np.zeros(1, bool)

    def work(part):
        begin = 0.5 * np.pi / parameters[part, FREQUENCY]
        # Tangents are computed only after patience/2 cycles, and only with a tangent can a run be
        # stopped as chaotic. Here patience/2 = periods + 1 exceeds the length of a run.
        settings = settling.tolerance, 2 * periods + 2, periods
        settle_many(parameters[part], states[part], begin, *settings, records[part], stop)

    run_chunks(work, len(states), running["workers"], running["progress"], stop)
    lasting = np.flatnonzero(records["outcome"] == UNRESOLVED)
    checked = replace(settling, patience=CHECKED, limit=CHECKED)
    again = ensemble.settle(
        parameters[lasting], records["state"][lasting], checked, from_strobe=True, **running
    )
    # A run ends at the distance NEAR from an orbit. A life ends earlier, at the distance CAPTURE.
    lives = records["periods_run"].astype(float)
    with np.errstate(divide="ignore", invalid="ignore"):
        decay = -np.log(np.abs(records["multiplier"])) / records["period"]
        approach = np.nan_to_num(np.log(CAPTURE / NEAR) / decay)
    lives = np.maximum(lives - approach, 1)
    # A transient that also lasts CHECKED further cycles has the life periods + 1, others `periods`.
    still = np.isin(again["outcome"], (CHAOTIC, UNRESOLVED))
    lives[lasting] = np.where(still, periods + 1, periods)
    return lives
