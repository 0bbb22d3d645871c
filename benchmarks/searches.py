"""The default search for motions compared with a search ten times as wide, with 1000 starts.

A start is a random initial state. A motion is missed if only the wide search finds it. A chaotic
motion may end after thousands of forcing cycles, and its size over a few cycles is a matter of
chance, so it is run longer before it counts as missed.

The force of a softening spring vanishes at a displacement called the barrier; beyond it motions
escape. Most starts of a wide search lie beyond the barrier, so escapes are counted separately, and
systems with a softening spring get another 1000 starts that reach up to the barrier.

If the default search has found a motion from none of its n starts, the share of starts that lead to
this motion is at most 3/n, at 95 % confidence. The default search states this bound.
"""

import math
import time
from typing import NamedTuple

import numpy as np
import pandas as pd

from impact_damper.data.datasets import flag, is_settled
from impact_damper.model.machine import Machine
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions import ensemble, strobe_map
from impact_damper.motions.response import frequency_response
from impact_damper.motions.start_states import barrier
from impact_damper.motions.sweep import SIMILAR, size_ratio
from impact_damper.theory.design_rule import peak_frequency

# Largest displacement and speed of starts in the wide search, divided by the default search's.
WIDER = 10.0
# Seeds of the random systems, and of the starts of the wide search.
SYSTEMS_SEED, SEED = 19, 6
# Forcing cycles for which a motion that has not settled is run longer.
LONG = 20000
# Settled motions are the same up to this relative difference of their sizes.
SAME = 1e-3
# Force (N), cubic stiffness (N/m^3), gap (m) and frequencies (Hz) of machines of 12 kg on 2e5 N/m.
MACHINES = {
    "hardening": (40, 4e9, 3e-3, (25, 30)),
    "linear": (40, 0, 3e-3, (19, 20.547, 22)),
    "softening": (10, -4e9, 1e-3, (18.5, 20)),
}


def named_systems():
    """Yield name, oscillator, damper and frequency W of the machines in `MACHINES`."""
    for name, (force, cubic, gap, frequencies) in MACHINES.items():
        machine = Machine(
            mass=12, linear_stiffness=2e5, cubic_stiffness=cubic, damping_ratio=0.005, force=force
        )
        damper = machine.damper(mass=0.6, gap=gap, restitution=0.8, contact_stiffness=4e8)
        for hertz in frequencies:
            frequency = machine.scales.from_si(hertz, "frequency")
            yield (
                f"{name}, {hertz:g} Hz",
                machine.oscillator(),
                damper.scaled(machine.scales),
                frequency,
            )


def random_systems(count):
    """Yield random systems as `named_systems` does.

    The clearances are near the paper's rule, and the frequencies near the resonance peak.
    """
    generator = np.random.default_rng(SYSTEMS_SEED)
    for i in range(count):
        cubic = generator.choice([1, -1]) * 10 ** generator.uniform(-3, 0)
        damping = 10 ** generator.uniform(-2, -0.7)
        # A larger force would carry a softening spring over its barrier before the peak.
        most = damping / math.sqrt(3 * abs(cubic))
        force = most * generator.uniform(0.1, 0.7) if cubic < 0 else 10 ** generator.uniform(-1, 0)
        oscillator = Oscillator(damping, 1.0, cubic=cubic, force=force)
        peak = peak_frequency(oscillator)
        mass_ratio = 10 ** generator.uniform(-2, -0.5)
        damper = Damper(
            mass_ratio,
            force / (mass_ratio * peak**2) * 10 ** generator.uniform(-0.5, 0.5),
            generator.uniform(0.5, 1),
            10 ** generator.uniform(3, 4.5),
        )
        yield f"random {i}", oscillator, damper, peak * generator.uniform(0.75, 1.15)


def wide_search(oscillator, damper, frequency, reaches, count):
    """Return the records of motions from random starts, `count` for each of `reaches`.

    A reach is a pair of displacement and speed, the half axes of the ellipsoid that contains the
    starts. The loose mass starts anywhere in its gap.
    """
    generator = np.random.default_rng(SEED)
    parts = []
    for displacement, speed in reaches:
        ball = generator.standard_normal((count, 4))
        ball *= generator.random((count, 1)) ** 0.25 / np.linalg.norm(ball, axis=1, keepdims=True)
        parts.append(ball * (displacement, speed, 0, speed))
    states = np.concatenate(parts)
    states[:, 2] = damper.clearance * generator.uniform(-1, 1, len(states))
    return ensemble.settle(
        np.tile(pack(oscillator, damper, frequency), (len(states), 1)), states, workers=2
    )


def run_on(p, state):
    """Return the record of the motion to which a state leads after LONG forcing cycles.

    `state` is a state at a strobe, the moment of each cycle at which W T = pi/2.
    """
    state, none = state.copy(), np.empty((0, 4))
    begin = strobe_map.strobe_time(p)
    strobe_map.flow(p, state, none, begin, LONG, np.bool_(False), strobe_map.POLISH_TOLERANCE)
    return ensemble.settle(p[None], state[None], from_strobe=True)[0]


def kind(motion):
    """Return outcome and period of a motion; drifting counts as without contact.

    Neither a loose mass at rest nor a slowly drifting loose mass acts on the machine.
    """
    alike = {flag("outcome", "drifting"): flag("outcome", "non_colliding")}
    outcome = int(motion["outcome"])
    return alike.get(outcome, outcome), int(motion["period"])


class Known(NamedTuple):
    """Motions that a search found.

    Attributes
    ----------
    motions : list of dict
        Outcome, period, largest displacement and state of each motion.
    later : list of records.MOTION
        Records of the motions that have not settled, after a longer run.
    """

    motions: list
    later: list

    def hold(self, record):
        """Return whether a motion is among the known motions.

        A settled motion must agree in size within SAME, any other motion within the factor SIMILAR.
        """
        here = [each for each in self.motions if kind(each) == kind(record)]
        size = record["maximum_displacement"]
        ratios = np.array([each["maximum_displacement"] / size for each in here])
        if is_settled(record):
            return bool((abs(ratios - 1) < SAME).any())
        alike = bool(((1 / SIMILAR < ratios) & (ratios < SIMILAR)).any())
        return alike or any(
            size_ratio(record, each) < SIMILAR for each in self.later if kind(each) == kind(record)
        )


def known_by(found, p):
    """Return the `Known` motions of a response at one frequency."""
    names = "outcome", "period", "maximum_displacement"
    motions = [
        {name: each[name].item() for name in names} | {"state": each["state"].values}
        for each in (found.isel(motion=i) for i in range(found.sizes["motion"]))
    ]
    later = [
        run_on(p, each["state"])
        for each in motions
        if not is_settled(each) and np.isfinite(each["state"]).all()
    ]
    return Known(motions, later)


def table(systems, count) -> pd.DataFrame:
    """Return a row for each system: sizes by both searches, and starts of missed motions."""
    rows = []
    for name, oscillator, damper, frequency in systems:
        begin = time.process_time()
        found = frequency_response(oscillator, damper, [frequency])
        spent = time.process_time() - begin
        reaches = [[WIDER * float(found[key][0]) for key in ("start_displacement", "start_speed")]]
        if oscillator.softens:
            reaches.append(barrier(oscillator))
        wide = wide_search(oscillator, damper, frequency, reaches, count)
        sizes = found["maximum_displacement"].values
        wide_sizes = wide["maximum_displacement"]
        bounded = wide[np.isfinite(wide_sizes)]
        p = pack(oscillator, damper, frequency)
        known = known_by(found.isel(frequency=0), p)
        missed = [each for each in bounded if not known.hold(each)]
        missed = [each for each in missed if not known.hold(run_on(p, each["state"]))]
        rows.append(
            {
                "system": name,
                "W": frequency,
                "CPU time of the default search in s": spent,
                "largest free motion": float(found["free_displacement"][0]),
                "largest motion, default search": np.max(sizes[np.isfinite(sizes)]),
                "largest motion, wide search": np.max(wide_sizes[np.isfinite(wide_sizes)]),
                "starts of the wide search at missed motions": len(missed),
                "starts of the wide search that escape": len(wide) - len(bounded),
                "of": len(wide),
                "bound stated by the default search": float(found["missed_share"]),
                "largest missed motion": max(
                    (each["maximum_displacement"] for each in missed), default=np.nan
                ),
            }
        )
    return pd.DataFrame(rows)
