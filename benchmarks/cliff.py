"""Where the cliff of impact dampers lies, for linear and hardening machines near their resonance.

`PYTHONPATH=src python -m benchmarks.cliff` prints the table of docs/explanation/trap.md. Lengths
are in units of F/k. The ratio `a` of a quiet orbit is its displacement over the smallest one that
its gap allows (the fold of the balance). The cliff is the largest gap at which at least half of the
starts become quiet, as they also do at the next smaller gap.
"""

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.ensemble import settle
from impact_damper.motions.simulate import random_states

RESTITUTIONS = 0.5, 0.6, 0.7, 0.8, 0.9
# Damping ratio and mass ratio of each machine.
MACHINES = (0.005, 0.05), (0.002, 0.02), (0.01, 0.1), (0.002, 0.08), (0.02, 0.05)
# Cubic part of the spring's force at the displacement 1/(2 damping ratio), over the linear part.
HARDENING = 0.0, 0.1
# Frequencies: these multiples of the mass ratio above the worst frequency.
OFFSETS = -0.3, 0.0, 0.3, 0.8
# Clearances over the clearance of the fold at the worst frequency.
PARTS = np.geomspace(0.4, 1.15, 24)
STARTS, STIFFNESS = 24, 100.0
BUILT = 0.8  # of the clearance by the rule
# A start is quiet if its displacement is below QUIET times the displacement of the balance.
QUIET = 1.4


def constants(restitution):
    """Return s = (1 - e)/(1 + e) and q = pi^2/4 + s^2."""
    s = (1 - restitution) / (1 + restitution)
    return s, np.pi**2 / 4 + s**2


def worst(damping, mass, restitution, cubic):
    """Return the least clearance of the fold over all frequencies, and its frequency."""
    s, q = constants(restitution)
    frequency = 1.0
    for _ in range(100):
        size = 1 / (2 * damping * frequency + np.pi * mass * frequency**2 / (s * q))
        frequency = np.sqrt((1 + 0.75 * cubic * size**2) / (1 - 2 * mass / q))
    return size * np.sqrt(q) / s, frequency


def force(a, clearance, damping, mass, restitution, cubic, frequency):
    """Return the force amplitude at which the quiet orbit has the ratio a."""
    s, q = constants(restitution)
    root = np.sqrt(a**2 - 1)
    size = a * s * clearance / np.sqrt(q)
    speed = clearance / q * (np.pi / 2 + s * root)
    along = s * clearance / q * (np.pi / 2 * root - s)  # displacement at the impacts
    impact = 4 * mass * speed * frequency**2 / np.pi
    lossy = 2 * damping * frequency * size + impact * s * speed / size
    elastic = (1 + 0.75 * cubic * size**2 - frequency**2) * size - impact * along / size
    return np.hypot(lossy, elastic)


def ratio(*given):
    """Return the ratio a of the quiet orbit at the force 1, or 1 beyond the fold."""
    if force(1.0, *given) >= 1:
        return 1.0
    grid = np.geomspace(1.0, 1e3, 400)
    values = np.array([force(a, *given) for a in grid]) - 1
    k = int(np.argmax(values > 0))
    return brentq(lambda a: force(a, *given) - 1, grid[k - 1], grid[k])


def clearance_at(a, damping, mass, restitution, cubic, frequency):
    """Return the least clearance at which the quiet orbit has the ratio a."""
    grid = np.geomspace(1e-2, 1e4, 2000)
    others = damping, mass, restitution, cubic, frequency
    values = np.array([force(a, d, *others) for d in grid]) - 1
    k = int(np.argmax(values > 0))
    return brentq(lambda d: force(a, d, *others) - 1, grid[k - 1], grid[k])


def least_ratio(restitution):
    """Return the ratio a at the cliff by a rule fitted to the cliffs of the table."""
    s, _ = constants(restitution)
    return max(1.0, 0.7 + 0.11 / s)


def sizes_at(clearances, oscillator, damping, mass, restitution, frequency):
    """Return the largest |Z1| of STARTS motions at each clearance, shape (clearances, STARTS)."""
    dampers = [Damper(mass, each, restitution, STIFFNESS) for each in clearances]
    rows = [np.tile(pack(oscillator, each, frequency), (STARTS, 1)) for each in dampers]
    starts = [random_states(STARTS, 0.75 / damping, each, 1) for each in dampers]
    run = np.concatenate(rows), np.concatenate(starts), Settling(limit=3000, further=0)
    return settle(*run, workers=2)["maximum_displacement"].reshape(len(dampers), STARTS)


def cliffs(damping, mass, restitution, hardening):
    """Return a dict for each frequency. Clearances are over the fold's at the worst frequency.

    optimum: clearance of the smallest motion that a start reaches; cliff, ratio: clearance and
    ratio a at the cliff; rule: clearance by `least_ratio`; built: share of quiet starts at BUILT
    times this clearance.
    """
    cubic = hardening / (0.75 * (0.5 / damping) ** 2)
    full, middle = worst(damping, mass, restitution, cubic)
    oscillator, (s, q) = Oscillator(2 * damping, 1.0, cubic=cubic), constants(restitution)
    found = []
    for frequency in middle + mass * np.array(OFFSETS):
        others = damping, mass, restitution, cubic, frequency
        rule = clearance_at(least_ratio(restitution), *others)
        clearances = np.append(PARTS * full, BUILT * rule)
        sizes = sizes_at(clearances, oscillator, damping, mass, restitution, frequency)
        ratios = np.array([ratio(each, *others) for each in clearances])
        bounds = QUIET * ratios * s * clearances / np.sqrt(q)
        shares = (sizes < bounds[:, None]).mean(axis=1)
        most = shares[:-1] >= 0.5
        kept = np.flatnonzero(most[1:] & most[:-1]) + 1
        k = int(kept[-1]) if len(kept) else 0
        if 0 < k < len(PARTS) - 1:
            optimum = PARTS[np.argmin(sizes[:-1].min(axis=1))]
            found.append({
                "e": restitution, "hardening": hardening, "damping": damping, "mass": mass,
                "frequency": frequency, "optimum": optimum, "cliff": PARTS[k],
                "ratio": ratios[k], "rule": rule / full, "built": shares[-1],
            })  # fmt: skip
    return found


def spread(values):
    """Return the median and the range of numbers as a text."""
    return f"{np.median(values):.2f} ({np.min(values):.2f} to {np.max(values):.2f})"


def table():
    """Return all cliffs, and for each restitution where they lie."""
    given = [(z, m, e, c) for e in RESTITUTIONS for c in HARDENING for z, m in MACHINES]
    found = pd.DataFrame([row for each in given for row in cliffs(*each)])
    lines = []
    for restitution, part in found.groupby("e"):
        line = {"e": restitution, "cases": len(part), "a by the rule": least_ratio(restitution)}
        line |= {"a at the cliff": spread(part["ratio"])}
        for hardening, some in part.groupby("hardening"):
            line[f"cliff/optimum, {hardening:g} cubic"] = spread(some["cliff"] / some["optimum"])
            line[f"rule/cliff, {hardening:g} cubic"] = spread(some["rule"] / some["cliff"])
        line["quiet at the built gap"] = spread(part["built"])
        line["more than half quiet"] = f"{(part['built'] > 0.5).sum()} of {len(part)}"
        lines.append(line)
    return found, pd.DataFrame(lines)


if __name__ == "__main__":
    cases, lines = table()
    print(cases.round(3).to_string(index=False))
    print(lines.round(2).to_markdown(index=False))
