"""Default searches against searches ten times as wide, with a thousand starts.

Motions that only the wide search finds are missed ones; escapes over the barrier of a softening
spring are counted by themselves, since the wide search also starts beyond the barrier. The default
search states a bound on the share of a motion that it missed: 3/n for n random starts, at 95 %.
"""

import math

import numpy as np
import pandas as pd

from impact_damper.data.datasets import is_settled
from impact_damper.machine.machine import Machine
from impact_damper.motions import ensemble
from impact_damper.motions.sweep import CHAOTIC_GAP
from impact_damper.stages.response import frequency_response
from impact_damper.system.packed import pack
from impact_damper.system.parameters import Damper, Oscillator
from impact_damper.theory.design_rule import peak_frequency

WIDER = 10.0
SEED = 5
# Settled motions are the same up to this relative difference of their sizes.
SAME = 1e-3
# Force (N), cubic stiffness (N/m^3), gap (m) and frequencies (Hz) of machines of 12 kg on 2e5 N/m.
MACHINES = {
    "hardening": (40, 4e9, 3e-3, (25, 30)),
    "linear": (40, 0, 3e-3, (19, 20.547, 22)),
    "softening": (10, -4e9, 1e-3, (18.5, 20)),
}


def named_systems():
    """Yield name, oscillator, damper and frequency W of the machines above."""
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
    """Yield as `named_systems` does, with dampers near their rule and frequencies near the peak."""
    generator = np.random.default_rng(18)
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


def wide_search(oscillator, damper, frequency, displacement, speed, count):
    """Return the records of motions from `count` starts, uniform in a ball of these half axes."""
    generator = np.random.default_rng(SEED)
    ball = generator.standard_normal((count, 4))
    ball *= generator.random((count, 1)) ** 0.25 / np.linalg.norm(ball, axis=1, keepdims=True)
    states = ball * (displacement, speed, 0, speed)
    states[:, 2] = damper.clearance * generator.uniform(-1, 1, count)
    return ensemble.settle(
        np.tile(pack(oscillator, damper, frequency), (count, 1)), states, workers=2
    )


def is_known(record, found):
    """Whether a search found a motion, or for one that has not settled one of about its size."""
    size = record["maximum_displacement"]
    alike = found["outcome"].values == record["outcome"]
    ratio = found["maximum_displacement"].values / size
    if is_settled(record):
        same = alike & (found["period"].values == record["period"]) & (abs(ratio - 1) < SAME)
        return bool(same.any())
    return bool(((1 / CHAOTIC_GAP < ratio) & (ratio < CHAOTIC_GAP)).any())


def table(systems, count) -> pd.DataFrame:
    """Return a row for each system: sizes by both searches, and the starts at missed motions."""
    rows = []
    for name, oscillator, damper, frequency in systems:
        found = frequency_response(oscillator, damper, [frequency])
        reach = (WIDER * float(found[key][0]) for key in ("start_displacement", "start_speed"))
        wide = wide_search(oscillator, damper, frequency, *reach, count)
        sizes = found["maximum_displacement"].values
        wide_sizes = wide["maximum_displacement"]
        bounded = wide[np.isfinite(wide_sizes)]
        missed = [each for each in bounded if not is_known(each, found.isel(frequency=0))]
        rows.append(
            {
                "system": name,
                "W": frequency,
                "largest free motion": float(found["free_displacement"][0]),
                "largest motion, default search": np.max(sizes[np.isfinite(sizes)]),
                "largest motion, wide search": np.max(wide_sizes[np.isfinite(wide_sizes)]),
                "starts of the wide search at missed motions": len(missed),
                "starts of the wide search that escape": count - len(bounded),
                "of": count,
                "bound stated by the default search": float(found["missed_share"]),
                "largest missed motion": max(
                    (each["maximum_displacement"] for each in missed), default=np.nan
                ),
            }
        )
    return pd.DataFrame(rows)
