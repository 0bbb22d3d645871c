"""The one-third subharmonic of the free oscillator, and its suppression by a damper.

Free means without the damper. The free subharmonic is a symmetric motion that repeats after three
forcing cycles (period 3). With the damper, every motion whose period is a multiple of 3 counts as a
subharmonic. A start is an initial state.

Z1 is the displacement of the primary mass.
"""

import numpy as np

from impact_damper.data.datasets import dataset, flag, touches_no_wall
from impact_damper.model.bounds import SEED_RANGE, check_count
from impact_damper.model.checks import check_frequencies, check_starts
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import check_damper, check_oscillator, describe
from impact_damper.model.settling import check_settling
from impact_damper.motions.free_subharmonic import (
    SEARCHED,
    branch_ends,
    free_subharmonic,
    is_subharmonic,
    switched_on,
)
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.motions.start_states import describe_search, search_starts
from impact_damper.motions.sweep import SAME, reached, sweep

# The frequencies extend beyond each end of the free subharmonic by BEYOND times the width of its
# range of frequencies.
BEYOND = 0.1
# A subharmonic counts as reduced if its max |Z1| is below REDUCED times that of the free one.
REDUCED = 0.95
# Motions that follow, or ways in which a run ends, if the damper is switched on during the free
# subharmonic.
SWITCHED_MOTIONS = (
    "quiet",
    "other_period_1",
    "subharmonic",
    "other_period",
    "chaotic",
    "non_colliding",
    "quasi_periodic",
    "unsettled",
)


def subharmonic_suppression(
    oscillator,
    damper,
    frequencies,
    *,
    starts=96,
    radius=None,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Find all motions with the damper at frequencies at which the free subharmonic exists.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequencies : sequence of float
        Increasing frequencies W, dimensionless. The free subharmonic is searched for from the first
        to the last. Damped motions are searched for at the same number of frequencies, spread over
        the range of the free subharmonic and a tenth of its width beyond each end; without a free
        subharmonic, at the given frequencies.
    starts : int
        Number of starts at each frequency. All are random, as in `frequency_response`,
        except at frequencies at which the free subharmonic exists. There one half of the starts has
        the primary mass on the free subharmonic and switches the damper on at a random time. The
        loose mass then has a random place, and a random velocity or, in every second of these
        starts, the velocity of the primary mass.
    radius, seed, settling, workers, progress
        As in `frequency_response`.

    Returns
    -------
    xarray.Dataset
        For each (frequency, motion) a motion found, as in a frequency response. For each
        `frequency` max |Z1| of the largest subharmonic without and with the damper (NaN where none
        exists), their ratio, contacts and period of the subharmonic with the damper, and flags for
        the effect of the damper on the subharmonic (removed, reduced, unchanged), judged by all
        motions with the damper and by those to which starts lead. For each (frequency,
        switched_motion) the share of starts on the free subharmonic that lead to this motion when
        the damper is switched on; a quiet motion has period 1 and two symmetric contacts. For each
        `edge` an end of the free subharmonic, for each (subharmonic, edge) an end of a branch with
        the damper.

    Raises
    ------
    TypeError
        If there is no damper.
    ValueError
        If the spring is linear, frequencies are not increasing, or a parameter is out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> found = idm.subharmonic_suppression(oscillator, damper, [1.9, 2.0])
    >>> idm.decode(found.free_subharmonic_event).values.tolist()
    ['sweep_ends', 'sweep_ends']
    """
    settling = check_settling(settling)
    check_damper(damper)
    check_oscillator(oscillator)
    if oscillator.is_linear:
        raise ValueError(
            "cubic = 0: must not be 0 (without the damper a linear spring has no subharmonic)"
        )
    frequencies = check_frequencies(frequencies, "two")
    check_starts(starts, max(SEARCHED, len(frequencies)), least=2)
    check_count("seed", seed, **SEED_RANGE)
    free = free_subharmonic(
        oscillator,
        frequencies[0],
        frequencies[-1],
        starts=starts,
        radius=radius,
        seed=seed,
        settling=settling,
        workers=workers,
    )
    if free.found:
        margin = BEYOND * (free.ends[1] - free.ends[0])
        frequencies = np.linspace(free.ends[0] - margin, free.ends[1] + margin, len(frequencies))
    parameters = np.array([pack(oscillator, damper, value) for value in frequencies])
    systems = [(damper, value) for value in frequencies]
    search = search_starts(oscillator, systems, starts, radius, seed, settling)
    size = _switch_half(oscillator, parameters, free, search.random, seed)
    data = sweep(
        parameters,
        FREQUENCY,
        "frequency",
        search,
        settling,
        workers=workers,
        progress=progress,
    )
    data |= _subharmonic_table(data, size) | _branch_table(data, frequencies)
    data |= {
        "switched_share": _shares(data, np.isfinite(size), starts // 2),
        "free_subharmonic_frequency": free.ends,
        "free_subharmonic_event": free.events,
    }
    made = describe(oscillator, damper, settling) | describe_search(starts, radius, seed)
    coordinates = {
        "frequency": frequencies,
        "component": list(COMPONENTS),
        "edge": ["lower", "upper"],
        "switched_motion": list(SWITCHED_MOTIONS),
    }
    return dataset(data, coordinates, made, "One-third subharmonic without and with the damper")


def _switch_half(oscillator, parameters, free, states, seed):
    """Replace half of the starts by states at which the damper is switched on.

    `states` are the starts, shape (n, m, 4), at n frequencies. Only starts at frequencies at which
    the free subharmonic exists are replaced. Return max |Z1| of the free subharmonic, shape (n,);
    NaN where it does not exist.
    """
    size = np.full(len(parameters), np.nan)
    half = states.shape[1] // 2
    for i, p in enumerate(parameters):
        record = free.at(p[FREQUENCY])
        if record is not None:
            size[i] = record["maximum_displacement"]
            generator = np.random.default_rng([seed, i, half])
            states[i, :half] = switched_on(
                oscillator, p, record["state"], states[i, :half], generator
            )
    return size


def _subharmonic_table(data, free):
    """Return the variables of the subharmonics without and with the damper at each frequency."""
    size = np.where(is_subharmonic(data), data["maximum_displacement"][1], -np.inf)
    place = np.argmax(size, axis=1)
    row = np.arange(len(size))
    damped = size[row, place]
    exists = damped > 0
    found = np.max(np.where(reached(data), size, -np.inf), axis=1)
    table = {"free_subharmonic": free, "subharmonic_ratio": np.where(exists, damped, 0) / free}
    for name, values in (("damped_subharmonic", damped), ("reached_subharmonic", found)):
        table[name] = np.where(values > 0, values, np.nan)
    for name, values in (("suppression", damped), ("reached_suppression", found)):
        table[name] = _suppression(values, free)
    table["damped_subharmonic_period"] = np.where(exists, data["period"][1][row, place], 0)
    table["damped_subharmonic_contacts"] = np.where(exists, data["contacts"][1][row, place], np.nan)
    return table


def _suppression(damped, free):
    """Return flags of `suppression` from max |Z1| with the damper and without it."""
    meanings = np.select(
        [np.isnan(free), damped < 0, damped < REDUCED * free],
        ["no_subharmonic_without_damper", "removed", "reduced"],
        "unchanged",
    )
    return np.array([flag("suppression", meaning) for meaning in meanings])


def _branch_table(data, frequencies):
    """Return the variables of the branches of subharmonics with the damper."""
    found = is_subharmonic(data)
    branch, period = data["branch"][1], data["period"][1]
    rows = []
    for number, n in np.unique(np.stack([branch[found], period[found]], axis=1), axis=0):
        cells = found & (branch == number) & (period == n)
        ends, events = branch_ends(data, number, frequencies, np.flatnonzero(cells.any(axis=1)))
        rows.append((number, n, np.max(data["maximum_displacement"][1][cells]), ends, events))
    names = ("subharmonic_branch", "subharmonic_period", "subharmonic_displacement")
    columns = zip(*rows, strict=True) if rows else [()] * 5
    *scalars, ends, events = (np.array(column) for column in columns)
    return dict(zip(names, scalars, strict=True)) | {
        "subharmonic_frequency": ends.reshape(-1, 2),
        "subharmonic_event": events.reshape(-1, 2),
    }


def _shares(data, present, count):
    """Return the share of the first `count` starts that lead to each of SWITCHED_MOTIONS.

    These starts lie on the free subharmonic. The shares are NaN at frequencies at which it does not
    exist (`present` is False).
    """
    settled = data["outcome"][1] == flag("outcome", "settled")
    period = data["period"][1]
    symmetric = (np.abs(data["contacts"][1] - 2) < SAME) & (data["asymmetry"][1] < SAME)
    kinds = np.select(
        [
            settled & (period == 1) & symmetric,
            settled & (period == 1),
            is_subharmonic(data),
            settled,
            data["outcome"][1] == flag("outcome", "chaotic"),
            touches_no_wall({"outcome": data["outcome"][1]}),
            data["outcome"][1] == flag("outcome", "quasi_periodic"),
        ],
        range(len(SWITCHED_MOTIONS) - 1),
        len(SWITCHED_MOTIONS) - 1,
    )
    reached = np.take_along_axis(kinds, data["run_motion"][1][:, :count], axis=1)
    shares = np.stack([np.mean(reached == k, axis=1) for k in range(len(SWITCHED_MOTIONS))], axis=1)
    return np.where(present[:, None], shares, np.nan)
