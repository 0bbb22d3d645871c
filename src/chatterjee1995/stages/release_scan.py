"""Free motions to which releases of the damper lead, at each frequency of a scan.

A release switches the damper off (`migration.damper_release`). Free means without the damper. At
the frequencies of a scan the free oscillator has two motions of period 1, a large and a small one,
and sometimes others.
"""

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.data.shares import BOUNDS
from impact_damper.data.variables import VARIABLES
from impact_damper.model.bounds import RUNS_RANGE, SCAN_LIFETIME_RANGE, check_count
from impact_damper.model.parameters import describe
from impact_damper.model.settling import check_settling
from impact_damper.motions import records
from impact_damper.motions.releases import (
    DESTINATIONS,
    release_case,
    release_data,
    watch_runs,
)
from impact_damper.motions.response import frequency_response
from impact_damper.motions.start_states import describe_search


def _scan_records(response):
    """Return an array of `records.MOTION` of the settled motions at one frequency of a response.

    Only the fields that `release_data` reads are set. The smallest motion comes first.
    """
    keep = response["outcome"].values == flag("outcome", "settled")
    found = np.zeros(np.sum(keep), records.MOTION)
    for name in ("period", "maximum_displacement", "contacts", "state"):
        found[name] = response[name].values[keep]
    return found[::-1]


def _padded(values, length):
    """Return an array, extended along its first axis to a length by NaN, or by -1 for integers."""
    missing = np.full(
        (length - len(values), *values.shape[1:]),
        np.nan if values.dtype.kind == "f" else -1,
        values.dtype,
    )
    return np.concatenate([values, missing])


def release_scan(
    oscillator,
    damper,
    frequencies,
    *,
    starts=24,
    radius=None,
    releases=100,
    lifetime=200,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Release the damper from every damped motion, at each frequency.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequencies : sequence of float
        Increasing forcing frequencies at which both free period-1 motions exist.
    starts : int
        Random starts at each frequency. The motions found are also followed to other frequencies.
    radius : float, optional
        As in `response.frequency_response`.
    releases : int
        Number of releases from each motion.
    lifetime : int
        Largest number of forcing cycles of a run that is released before it settles.
    seed : int
    settling : Settling, optional
    workers, progress
        As in `response.frequency_response`.

    Returns
    -------
    xarray.Dataset
        For each (frequency, damped) a motion with the damper; the first one has not settled. For
        each (frequency, damped, free_motion, bound) the share of its releases that lead to a free
        motion, or a confidence bound of this share.

    Raises
    ------
    ValueError
        If a free motion of period 1 is missing at a frequency, or an argument is out of range.
    """
    settling = check_settling(settling)
    check_count("releases", releases, **RUNS_RANGE)
    check_count("lifetime", lifetime, **SCAN_LIFETIME_RANGE)
    cases = [release_case(oscillator, damper, frequency, settling) for frequency in frequencies]
    response = frequency_response(
        oscillator,
        damper,
        frequencies,
        starts=starts,
        radius=radius,
        seed=seed,
        settling=settling,
        workers=workers,
        progress=progress,
    )
    seeds = np.random.SeedSequence(seed).spawn(len(cases))
    rows = []
    for i, case in enumerate(cases):
        _, _, entries = watch_runs(
            case, seeds[i].spawn(releases), lifetime, settling, workers, None
        )
        rows.append(
            release_data(case, _scan_records(response.isel(frequency=i)), entries, settling)
        )
    width = max(len(row["damped_kind"]) for row in rows)
    names = (
        "damped_kind",
        "damped_period",
        "damped_displacement",
        "damped_contacts",
        "release_share",
    )
    data = {name: np.array([_padded(row[name], width) for row in rows]) for name in names}
    data = {name: (("frequency", *VARIABLES[name].dims), values) for name, values in data.items()}
    made = describe(oscillator, damper, settling) | describe_search(starts, radius, seed)
    made |= {"releases": releases, "lifetime": lifetime}
    coordinates = {
        "frequency": response["frequency"].values,
        "free_motion": DESTINATIONS,
        "bound": BOUNDS,
    }
    return dataset(data, coordinates, made, "Free motions to which releases of the damper lead")
