"""Load and realised restitution of the contacts of simulated motions.

`contact_law` defines both. Random starts lead to motions, and each contact of two of these motions
is recorded ("logged"): the smallest settled motion with contacts, and the largest motion with
contacts, settled or not.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass, W the
forcing frequency, and T the time.
"""

from dataclasses import replace

import numpy as np

from impact_damper.data.datasets import flag, is_settled
from impact_damper.kernel.equation import acceleration
from impact_damper.model.packed import DASHPOT, FREQUENCY, pack
from impact_damper.motions import ensemble, records, strobe_map, traces
from impact_damper.motions.following import follow_stable
from impact_damper.motions.simulate import random_states
from impact_damper.theory.contact_law import contact, natural_frequency

# The restitution of a contact is "close" to the intended e if its relative error is at most CLOSE,
# and "fair" if it is at most FAIR.
CLOSE, FAIR = 0.01, 0.05
SIZES = ("smallest", "largest")
# `without_pull` follows an orbit to another dashpot coefficient. If the stable orbit ends before,
# the coefficient at its end is located to within RESOLUTION.
RESOLUTION = 1e-6
# Largest number of contacts that are logged.
LARGEST_LOG = 10**5
# The error of a motion is the quantile MOST of the errors of its contacts.
MOST = 0.99


def logged_contacts(oscillator, damper, frequency, state, periods):
    """Return load, restitution and duration of the contacts of a motion.

    Contacts that do not both begin and end within the logged time are omitted.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
        W.
    state : array, shape (4,)
        Z1, Z1', Z2, Z2' at W T = pi/2.
    periods : int
        Logged time in forcing cycles.

    Returns
    -------
    dict of numpy.ndarray
        Arrays with one entry for each contact, dimensionless. `load`: g/(wn v0) at the beginning of
        the contact. `restitution`: speed of departure divided by speed of approach. `duration`:
        duration divided by pi/wn, which is the duration of an elastic contact without load.

    Raises
    ------
    ValueError
        If there are more than LARGEST_LOG contacts.
    """
    p = pack(oscillator, damper, frequency)
    begin = strobe_map.strobe_time(p)
    times = np.array([begin + periods * 2 * np.pi / p[FREQUENCY]])
    log, states = np.empty((LARGEST_LOG, 5)), np.empty((1, 4))
    tolerance = strobe_map.POLISH_TOLERANCE
    count = traces.trace(p, np.array(state), begin, times, tolerance, states, log)
    if count > LARGEST_LOG:
        raise ValueError(f"periods = {periods}: more than {LARGEST_LOG} contacts in this time")
    # The same integration is repeated to store the states at which contacts begin.
    times = np.append(log[:count, 1], times)
    states = np.empty((len(times), 4))
    traces.trace(p, np.array(state), begin, times, tolerance, states, log)
    side, start, end, approach, departure = log[:count].T
    load = side * [acceleration(p, y, t) for y, t in zip(states[:-1], start, strict=True)]
    natural = natural_frequency(damper)
    whole = np.isfinite(end) & (start > begin)
    return {
        "load": (load / (natural * np.abs(approach)))[whole],
        "restitution": (-departure / approach)[whole],
        "duration": ((end - start) * natural / np.pi)[whole],
    }


def extreme_motions(oscillator, damper, frequency, starts, seed, settling):
    """Return the smallest settled motion with contacts, and the largest motion with contacts.

    Each is a record of type `records.MOTION`, or None if there is no such motion.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
        W.
    starts : int
        Number of random starts within the gap.
    seed : int or sequence of int
    settling : Settling
    """
    p = pack(oscillator, damper, frequency)
    states = random_states(starts, damper.clearance, damper, seed)
    motions = ensemble.settle(np.tile(p, (starts, 1)), states, settling)
    touching = motions[(motions["contacts"] > 0) & np.isfinite(motions["maximum_displacement"])]
    settled = touching[is_settled(touching)]
    return (
        settled[np.argmin(settled["maximum_displacement"])] if len(settled) else None,
        touching[np.argmax(touching["maximum_displacement"])] if len(touching) else None,
    )


def compare_contacts(oscillator, damper, frequency, motion, periods):
    """Compare the realised restitution of a motion with e and with the closed form.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
        W.
    motion : records.MOTION or None
    periods : int
        Forcing cycles over which contacts are logged.

    Returns
    -------
    table : dict
        Values of registered variables, keyed by name.
    logged : dict or None
        Result of `logged_contacts`; None without a motion.
    """
    if motion is None:
        return {
            "scene_outcome": flag("outcome", "absent"),
            "scene_without_pull_status": flag("scene_without_pull_status", "absent"),
        }, None
    logged = logged_contacts(oscillator, damper, frequency, motion["state"], periods)
    ends = [contact(damper.restitution, load, "zero_penetration") for load in logged["load"]]
    released = np.array([end.outcome == "released" for end in ends])
    restitution = np.array([end.departure for end in ends])
    duration = np.array([end.duration for end in ends]) / np.pi
    error = np.abs(logged["restitution"] / damper.restitution - 1)
    displacement, status = without_pull(oscillator, damper, frequency, motion)
    table = {
        "scene_outcome": motion["outcome"],
        "scene_displacement": motion["maximum_displacement"],
        "scene_without_pull": displacement,
        "scene_without_pull_status": status,
        "scene_contacts": len(error),
        "scene_unreleased": np.sum(~released),
    }
    if released.any():
        table |= {
            "scene_close": np.mean(error <= CLOSE),
            "scene_fair": np.mean(error <= FAIR),
            "scene_load": np.quantile(np.abs(logged["load"]), MOST),
            "scene_restitution_low": logged["restitution"].min(),
            "scene_restitution_high": logged["restitution"].max(),
            "scene_restitution_error": _most(restitution - logged["restitution"], released),
            "scene_duration_error": _most(duration - logged["duration"], released),
        }
    return table, logged


def _most(error, released):
    """Return the quantile MOST of |error| over the contacts that end in a separation."""
    return np.quantile(np.abs(error[released]), MOST)


def without_pull(oscillator, damper, frequency, motion):
    """Estimate max |Z1| of a settled motion under the rule `no_tension`, when walls never pull.

    The simulation ends contacts by the rule `zero_penetration`. With the same dashpot, the rule
    `no_tension` realises a higher restitution without load. The function follows the orbit to the
    weaker dashpot with which `zero_penetration` realises this restitution. The duration of the
    contacts is not corrected.

    Returns
    -------
    displacement : float
        max |Z1|, dimensionless; NaN unless the status is found.
    status : int
        Flag of `scene_without_pull_status`: found; not_settled; not_followed if the orbit cannot be
        followed to the weaker dashpot; other_contacts if the followed orbit has another number of
        contacts.
    """
    if not is_settled(motion):
        return np.nan, flag("scene_without_pull_status", "not_settled")
    returned = contact(damper.restitution, 0.0, "no_tension").departure
    goal = replace(damper, restitution=min(returned, 1.0)).dashpot
    p = pack(oscillator, damper, frequency)
    if p[DASHPOT] == goal:
        return motion["maximum_displacement"], flag("scene_without_pull_status", "found")
    period = int(motion["period"])
    p, orbit = follow_stable(p, motion["state"], period, DASHPOT, goal, RESOLUTION)
    if p[DASHPOT] != goal:
        return np.nan, flag("scene_without_pull_status", "not_followed")
    record = records.measured(p, orbit.state, period, strobe_map.POLISH_TOLERANCE)
    if record["contacts"] != motion["contacts"]:
        return np.nan, flag("scene_without_pull_status", "other_contacts")
    return record["maximum_displacement"], flag("scene_without_pull_status", "found")
