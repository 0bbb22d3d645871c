"""Contacts of simulated motions: how they are loaded, and what they return.

At each restitution and frequency the smallest settled motion and the largest motion that
random starts reach are looked at, as far as they have contacts.
"""

from dataclasses import replace

import numpy as np

from impact_damper.contact.contact_law import contact, natural_frequency
from impact_damper.data.datasets import flag, is_settled
from impact_damper.kernel.equation import acceleration
from impact_damper.motions import ensemble, records, strobe_map
from impact_damper.motions.following import follow_stable
from impact_damper.motions.simulate import random_states
from impact_damper.system.packed import DASHPOT, FREQUENCY, pack

CLOSE, FAIR = 0.01, 0.05
SIZES = ("smallest", "largest")
RESOLUTION = 1e-6
LARGEST_LOG = 10**5
# Share of the contacts that an error stated for a motion covers.
MOST = 0.99


def logged_contacts(oscillator, damper, frequency, state, periods):
    """Contacts of a motion from a state at W T = pi/2 on that begin and end within some periods.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
    state : array, shape (4,)
    periods : int

    Returns
    -------
    dict
        Over the contacts: `load` g/(wn v0) at the beginning, `restitution` that is realised, and
        `duration` over that of an elastic contact.

    Raises
    ------
    ValueError
        If there are more contacts than the log holds.
    """
    p = pack(oscillator, damper, frequency)
    begin = strobe_map.strobe_time(p)
    times = np.array([begin + periods * 2 * np.pi / p[FREQUENCY]])
    log, states = np.empty((LARGEST_LOG, 5)), np.empty((1, 4))
    tolerance = strobe_map.POLISH_TOLERANCE
    count = records.trace(p, np.array(state), begin, times, tolerance, states, log)
    if count > LARGEST_LOG:
        raise ValueError(f"periods = {periods}: more than {LARGEST_LOG} contacts in so many")
    # the same steps again, now with samples where contacts begin
    times = np.append(log[:count, 1], times)
    states = np.empty((len(times), 4))
    records.trace(p, np.array(state), begin, times, tolerance, states, log)
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
    """Records of the smallest settled and the largest motion with contacts, None if absent."""
    p = pack(oscillator, damper, frequency)
    states = random_states(starts, damper.clearance, damper, seed)
    found = ensemble.settle(np.tile(p, (starts, 1)), states, settling)
    touching = found[(found["contacts"] > 0) & np.isfinite(found["maximum_displacement"])]
    settled = touching[is_settled(touching)]
    return (
        settled[np.argmin(settled["maximum_displacement"])] if len(settled) else None,
        touching[np.argmax(touching["maximum_displacement"])] if len(touching) else None,
    )


def scene(oscillator, damper, frequency, motion, periods):
    """What the contacts of one motion return, against e and against the closed form.

    Returns
    -------
    table : dict
        Registered variables.
    seen : dict or None
        `logged_contacts`, None without a motion.
    """
    if motion is None:
        return {
            "scene_outcome": flag("outcome", "absent"),
            "scene_without_pull_status": flag("scene_without_pull_status", "absent"),
        }, None
    seen = logged_contacts(oscillator, damper, frequency, motion["state"], periods)
    ends = [contact(damper.restitution, load, "zero_penetration") for load in seen["load"]]
    released = np.array([end.outcome == "released" for end in ends])
    restitution = np.array([end.departure for end in ends])
    duration = np.array([end.duration for end in ends]) / np.pi
    error = np.abs(seen["restitution"] / damper.restitution - 1)
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
            "scene_load": np.quantile(np.abs(seen["load"]), MOST),
            "scene_restitution_low": seen["restitution"].min(),
            "scene_restitution_high": seen["restitution"].max(),
            "scene_restitution_error": _most(restitution - seen["restitution"], released),
            "scene_duration_error": _most(duration - seen["duration"], released),
        }
    return table, seen


def _most(error, released):
    return np.quantile(np.abs(error[released]), MOST)


def without_pull(oscillator, damper, frequency, motion):
    """max |Z1| of a settled motion for the restitution that walls without pull would return.

    The rule `no_tension` is mapped to the restitution it returns without load: the time in
    contact stays that of the rule `zero_penetration`.

    Returns
    -------
    displacement : float
        NaN unless found.
    status : int
        Flag of `scene_without_pull_status`: whether the motion has settled, its orbit can be
        followed there, and has as many contacts there.
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
