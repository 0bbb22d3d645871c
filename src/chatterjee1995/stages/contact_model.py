"""Map of the contact model over restitution and load, and contacts of simulated motions.

Equation (25) of the paper gives the dashpot for which a contact has the restitution e if no other
force acts and the contact ends at zero penetration. Other forces cause an acceleration g of the
primary mass towards the wall. The load is G = g/(wn v0), with the natural frequency wn of the
contact and the speed of approach v0. At the end of a contact the dashpot pulls the loose mass. With
walls that cannot pull the contact ends sooner. The map gives the restitution that a contact has
under load, for both rules for its end (exit rules). Contacts of simulated motions show which loads
occur.
"""

from dataclasses import replace

import numpy as np

from chatterjee1995.stages.logged_contacts import (
    CLOSE,
    FAIR,
    SIZES,
    compare_contacts,
    extreme_motions,
)
from chatterjee1995.variables.contact import SCENE
from impact_damper.data.datasets import dataset, flag
from impact_damper.data.variables import VARIABLES
from impact_damper.model.bounds import (
    LOAD_RANGE,
    PERIODS_RANGE,
    POINTS_RANGE,
    RUNS_RANGE,
    check_count,
    check_number,
)
from impact_damper.model.checks import check_frequencies, check_increasing
from impact_damper.model.parameters import check_damper, describe
from impact_damper.model.settling import check_settling
from impact_damper.theory.contact_law import EXIT_RULES, contact, damping_ratio, tension

# The loads of the map are evenly spaced up to |G| of about LINEAR, and logarithmically above it.
LINEAR = 1e-3
# Variables with one value for each logged contact.
# LOG: indices of its motion: of the restitution, the frequency and the size.
# LOGGED: names under which the quantities of `logged_contacts` are stored.
LOG = ("contact_used", "contact_row", "contact_size")
LOGGED = {
    "load": "contact_load",
    "restitution": "contact_restitution",
    "duration": "contact_time",
}

# Variables of motions that are integers.
COUNTED = ("scene_outcome", "scene_without_pull_status", "scene_contacts", "scene_unreleased")


def contact_model(
    oscillator,
    damper,
    frequencies,
    restitutions,
    loads,
    *,
    used,
    starts=8,
    periods=200,
    seed=1995,
    settling=None,
):
    """Compute the contact for each restitution and load, and log contacts of simulated motions.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
        Its restitution is replaced by the values in `used`.
    frequencies : sequence of float
        Increasing forcing frequencies W of the motions, dimensionless.
    restitutions, loads : sequence of float
        Increasing e and G = g/(wn v0) of the map, dimensionless.
    used : sequence of float
        Increasing restitutions of the motions.
    starts : int
        Number of random starts of the search for motions at each restitution and frequency.
    periods : int
        Forcing cycles over which the contacts of a motion are logged.
    seed : int
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        For each (exit_rule, load, restitution) the contact in closed form; for each restitution
        `used` the same without load; for each (used, frequency, size) a simulated motion, the
        smallest or the largest one; and for each `contact` its load, restitution and duration.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    settling = check_settling(settling)
    check_damper(damper)
    check_count("starts", starts, **RUNS_RANGE)
    check_count("periods", periods, **PERIODS_RANGE)
    frequencies = check_frequencies(frequencies)
    restitutions, loads, used = (
        check_increasing(name, values, "two")
        for name, values in (("restitutions", restitutions), ("loads", loads), ("used", used))
    )
    dampers = [replace(damper, restitution=float(e)) for e in used]
    data = (
        contact_map(restitutions, loads)
        | unloaded_table(used)
        | _motions(oscillator, dampers, frequencies, starts, periods, seed, settling)
    )
    made = describe(oscillator, damper, settling)
    made |= {"starts": starts, "periods": periods, "seed": seed}
    del made["restitution"]
    coordinates = {
        "exit_rule": list(EXIT_RULES),
        "load": loads,
        "restitution": restitutions,
        "used": used,
        "frequency": frequencies,
        "size": list(SIZES),
    }
    return dataset(data, coordinates, made, "The contact model over restitution and load")


def spread_loads(largest, count):
    """Return loads from -largest to largest, evenly spaced near 0, logarithmically above LINEAR."""
    check_number("largest", largest, **LOAD_RANGE)
    check_count("count", count, **POINTS_RANGE)
    return LINEAR * np.sinh(np.linspace(-1, 1, count) * np.arcsinh(largest / LINEAR))


def contact_map(restitutions, loads):
    """Return the contact in closed form for each exit rule, load and restitution.

    Parameters
    ----------
    restitutions, loads : array
        e and G = g/(wn v0), dimensionless.

    Returns
    -------
    dict
        Variables of the dataset: realised restitution (NaN if the loose mass does not leave the
        wall), time in contact divided by that of an elastic contact (NaN if the contact does not
        end), the verdict on each cell (`_verdict`), and impulse and largest force of the wall's
        pull, divided by those of its push.
    """
    shape = len(EXIT_RULES), len(loads), len(restitutions)
    realised, duration = np.empty(shape), np.empty(shape)
    verdict = np.empty(shape, np.int8)
    impulse, peak = np.empty(shape[1:]), np.empty(shape[1:])
    for j, load in enumerate(loads):
        for k, restitution in enumerate(restitutions):
            for i, rule in enumerate(EXIT_RULES):
                found = contact(restitution, load, rule)
                realised[i, j, k], duration[i, j, k] = found.departure, found.duration / np.pi
                verdict[i, j, k] = flag("contact_verdict", _verdict(found, restitution))
            _, impulse[j, k], peak[j, k] = tension(restitution, load)
    return {
        "realised_restitution": realised,
        "contact_duration": np.where(np.isfinite(duration), duration, np.nan),
        "contact_verdict": verdict,
        "pull_impulse": impulse,
        "pull_peak": peak,
    }


def _verdict(found, restitution):
    """Return the flag `contact_verdict`: the size of the error, or why the loose mass stays."""
    if found.outcome != "released":
        return found.outcome
    error = abs(found.departure / restitution - 1)
    return "close" if error <= CLOSE else "fair" if error <= FAIR else "off"


def unloaded_table(restitutions):
    """Return the variables of contacts without load, one value for each restitution."""
    ends = [[contact(e, 0.0, rule) for e in restitutions] for rule in EXIT_RULES]
    pulls = [tension(e, 0.0) for e in restitutions]
    return {
        "unloaded_damping": [damping_ratio(e) for e in restitutions],
        "unloaded_restitution": [[end.departure for end in row] for row in ends],
        "unloaded_duration": [[end.duration / np.pi for end in row] for row in ends],
        "unloaded_pull_time": [pull.time for pull in pulls],
        "unloaded_pull_impulse": [pull.impulse for pull in pulls],
        "unloaded_pull_peak": [pull.peak for pull in pulls],
    }


def _motions(oscillator, dampers, frequencies, starts, periods, seed, settling):
    """Return the variables of the simulated motions and of all their contacts."""
    shape = len(dampers), len(frequencies), len(SIZES)
    table = {
        name: np.zeros(shape, np.int64) if name in COUNTED else np.full(shape, np.nan)
        for name, entry in VARIABLES.items()
        if entry.dims == SCENE
    }
    log = {name: [np.empty(0, np.int64)] for name in LOG} | {
        name: [np.empty(0)] for name in LOGGED.values()
    }
    for i, damper in enumerate(dampers):
        for j, frequency in enumerate(frequencies):
            found = extreme_motions(oscillator, damper, frequency, starts, [seed, i, j], settling)
            for k, motion in enumerate(found):
                row, logged = compare_contacts(oscillator, damper, frequency, motion, periods)
                for name, value in row.items():
                    table[name][i, j, k] = value
                if logged is None:
                    continue
                for name, place in zip(LOG, (i, j, k), strict=True):
                    log[name].append(np.full(len(logged["load"]), place))
                for name, column in LOGGED.items():
                    log[column].append(logged[name])
    return table | {name: np.concatenate(parts) for name, parts in log.items()}
