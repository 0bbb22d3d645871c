"""Map of the contact model over restitution and load, and the loads of simulated motions.

The load is G = g/(wn v0). g is the acceleration Z2'' without the contact force, positive towards
the wall, wn the natural frequency of the contact, and v0 the approach speed.
"""

from dataclasses import replace

import numpy as np

from chatterjee1995.methods.contact_law import contact, pull_time
from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.data.variables import register
from impact_damper.kernel.equation import acceleration
from impact_damper.model.exit_rules import EXIT_RULES
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.motions import ensemble, strobe_map, traces
from impact_damper.motions.simulate import random_states

register(
    """
exit_rule | exit_rule | | | rule for the end of a contact
load | load | | g/(omega_n v0) | load in contact
realised_restitution | exit_rule load restitution | | | departure speed divided by approach speed
contact_verdict | exit_rule load restitution | | | realised restitution: within 1 % of e, within 5
  %, or farther; or none, because the loose mass falls back or the contact does not end
  : close 0, fair 1, off 2, falls_back 3, no_release 4
used | used | | e | coefficient of restitution of a damper
unloaded_restitution | exit_rule used | | | realised restitution without load
unloaded_duration | exit_rule used | | | time in contact / time in an elastic contact, without
  load
unloaded_pull_time | used | | | fraction of the time in contact in which the force is tensile
size | size | | | smallest settled or largest motion to which random starts lead
contact_used | contact | | | index along the dimension `used` of a contact
contact_size | contact | | | index along the dimension `size` of a contact
contact_load | contact | | | load at the beginning of a contact
    """
)

LINEAR = 1e-3  # |G| below which the loads of the map are spaced almost evenly
CLOSE, FAIR = 0.01, 0.05  # largest relative errors for the verdicts "close" and "fair"
SIZES = ("smallest", "largest")  # names of the simulated motions, see `extreme_motions`


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
    settling,
):
    """Return a dataset: a map of contacts over `restitutions` and `loads`, and loads in motions.

    For each restitution in `used`, motions start at random at each of `frequencies`. The loads are
    those of contacts in `periods` cycles of the smallest settled motion and of the largest motion.
    """
    used, frequencies = np.array(used, float), np.array(frequencies, float)
    data = contact_map(restitutions, loads) | unloaded_table(used)
    rows = [[np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)]]
    for i, e in enumerate(used):
        each = replace(damper, restitution=float(e))
        for j, frequency in enumerate(frequencies):
            found = extreme_motions(oscillator, each, frequency, starts, [seed, i, j], settling)
            for size, motion in enumerate(found):
                if motion is not None:
                    log = loads_of(oscillator, each, frequency, motion["state"], periods)
                    rows.append([np.full(len(log), i), np.full(len(log), size), log])
    names = "contact_used", "contact_size", "contact_load"
    data |= dict(zip(names, map(np.concatenate, zip(*rows, strict=True)), strict=True))
    made = describe(oscillator, damper, settling)
    made |= {"starts": starts, "periods": periods, "seed": seed, "frequencies": list(frequencies)}
    del made["restitution"]
    coordinates = {"exit_rule": list(EXIT_RULES), "load": loads, "restitution": restitutions}
    coordinates |= {"used": used, "size": list(SIZES)}
    return dataset(data, coordinates, made, "The contact model over restitution and load")


def spread_loads(largest, count):
    """Return `count` loads LINEAR * sinh(s) from -largest to largest, with equally spaced s."""
    return LINEAR * np.sinh(np.linspace(-1, 1, count) * np.arcsinh(largest / LINEAR))


def contact_map(restitutions, loads):
    """Return a dict: variables of the dataset that depend on exit rule, load and restitution."""
    shape = len(EXIT_RULES), len(loads), len(restitutions)
    realised, verdict = np.empty(shape), np.empty(shape, np.int8)
    for i, j, k in np.ndindex(shape):
        found = contact(restitutions[k], loads[j], EXIT_RULES[i])
        realised[i, j, k] = found.departure
        verdict[i, j, k] = flag("contact_verdict", _verdict(found, restitutions[k]))
    return {"realised_restitution": realised, "contact_verdict": verdict}


def _verdict(found, restitution):
    if found.outcome != "released":
        return found.outcome
    error = abs(found.departure / restitution - 1)
    return "close" if error <= CLOSE else "fair" if error <= FAIR else "off"


def unloaded_table(restitutions):
    """Return a dict: the variables of the dataset that describe contacts without load."""
    ends = [[contact(e, 0.0, rule) for e in restitutions] for rule in EXIT_RULES]
    return {
        "unloaded_restitution": [[end.departure for end in row] for row in ends],
        "unloaded_duration": [[end.duration / np.pi for end in row] for row in ends],
        "unloaded_pull_time": [pull_time(e, 0.0) for e in restitutions],
    }


def extreme_motions(oscillator, damper, frequency, starts, seed, settling):
    """Run motions from random starts. Return the smallest settled one, and the largest of all.

    Only motions with contacts count. The largest motion need not have settled. If none has settled,
    the first result is None. If no motion has contacts, both results are None.
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


def loads_of(oscillator, damper, frequency, state, periods):
    """Return the load at the beginning of each complete contact in a run from W T = pi/2."""
    p = pack(oscillator, damper, frequency)
    begin = strobe_map.strobe_time(p)
    times = np.array([begin + periods * 2 * np.pi / p[FREQUENCY]])
    tolerance = strobe_map.POLISH_TOLERANCE
    _, log = traces.trace(p, state, begin, times, tolerance)
    states = traces.states_at(p, state, begin, np.append(log[:, 1], times), tolerance)
    side, start, end, approach, _ = log.T
    load = side * [acceleration(p, y, t) for y, t in zip(states[:-1], start, strict=True)]
    whole = np.isfinite(end) & (start > begin)
    return (load / (damper.contact_frequency * np.abs(approach)))[whole]
