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


def cliffs(damping, mass, restitution, hardening):
    """Return rows: frequency, clearance of the cliff over the fold's, ratio a at the cliff."""
    cubic = hardening / (0.75 * (0.5 / damping) ** 2)
    full, middle = worst(damping, mass, restitution, cubic)
    oscillator, (s, q) = Oscillator(2 * damping, 1.0, cubic=cubic), constants(restitution)
    rows = []
    for frequency in middle + mass * np.array(OFFSETS):
        dampers = [Damper(mass, part * full, restitution, STIFFNESS) for part in PARTS]
        packed = [np.tile(pack(oscillator, each, frequency), (STARTS, 1)) for each in dampers]
        starts = [random_states(STARTS, 0.75 / damping, each, 1) for each in dampers]
        run = np.concatenate(packed), np.concatenate(starts), Settling(limit=3000, further=0)
        sizes = settle(*run, workers=2)["maximum_displacement"].reshape(len(PARTS), STARTS)
        others = damping, mass, restitution, cubic, frequency
        ratios = np.array([ratio(part * full, *others) for part in PARTS])
        bound = QUIET * ratios * s * PARTS * full / np.sqrt(q)
        most = (sizes < bound[:, None]).mean(axis=1) >= 0.5
        found = np.flatnonzero(most[1:] & most[:-1])
        k = int(found[-1]) + 1 if len(found) else 0
        if 0 < k < len(PARTS) - 1:
            rows.append({
                "e": restitution, "hardening": hardening, "damping": damping, "mass": mass,
                "frequency": frequency, "clearance": PARTS[k], "ratio": ratios[k], "full": full,
            })  # fmt: skip
    return rows


def table():
    """Return all cliffs, and for each restitution how well `least_ratio` predicts their gaps."""
    given = [(z, m, e, c) for e in RESTITUTIONS for c in HARDENING for z, m in MACHINES]
    found = pd.DataFrame([row for each in given for row in cliffs(*each)])
    lines = []
    for restitution, part in found.groupby("e"):
        a = least_ratio(restitution)
        predicted = [
            clearance_at(a, z, m, restitution, c / (0.75 * (0.5 / z) ** 2), w)
            for z, m, c, w in part[["damping", "mass", "hardening", "frequency"]].to_numpy()
        ]
        error = np.array(predicted) / (part["clearance"] * part["full"])
        line = {"e": restitution, "cases": len(part), "a by the rule": a}
        line |= {"a, median": part["ratio"].median()}
        line |= {"a, least": part["ratio"].min(), "a, greatest": part["ratio"].max()}
        for hardening, some in error.groupby(part["hardening"]):
            line[f"gap, {hardening:g} cubic"] = f"{some.min():.2f} to {some.max():.2f}"
        lines.append(line)
    return found, pd.DataFrame(lines)


if __name__ == "__main__":
    cases, lines = table()
    print(cases.round(3).to_string(index=False))
    print(lines.round(2).to_markdown(index=False))
