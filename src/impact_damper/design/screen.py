"""First look at a design: the bare machine, rules for the gap, and exact quiet orbits.

The screening uses the cheapest model that answers a question. Harmonic balance gives the response
without the damper; the flight rule and, for a linear machine, the slow invariant manifold give the
range of gaps; a few motions give quiet orbits, and Newton's method follows them over gap and
frequency with their multipliers. Only the verification that comes next runs motions from many
starts.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.design.outcomes import Case, run
from impact_damper.literature.slow_invariant_manifold import VibroImpactAbsorber
from impact_damper.motions.free_motions import balance_amplitudes
from impact_damper.orbits.quiet_orbits import follow_quiet_orbits, is_symmetric_pair

# Gaps of the map of quiet orbits: the least, divided by the gap of the flight rule at the highest
# frequency; the greatest, divided by that at the lowest frequency; and number.
LEAST, MOST, GAPS = 0.3, 1.7, 40
# Gap of the flight rule divided by that of rule (18), near e = 1 (`theory.straight_flight`).
FLIGHT = 1.14
# Random starts, gaps and frequencies from which quiet orbits are first reached.
SEEDED = 16
SEED_GAPS = (0.3, 0.5, 0.7, 0.9, 1.05)
SEED_FREQUENCIES = 5


class Screening(NamedTuple):
    """What the first look finds.

    Attributes
    ----------
    frequencies : numpy.ndarray, shape (n,)
        Hz.
    bare : numpy.ndarray, shape (n,)
        Largest displacement without the damper by harmonic balance, mm.
    worst : int
        Index of the frequency at which the bare machine moves most.
    rule_gap, manifold_gap : float
        Gap by the flight rule, and by the slow invariant manifold at the resonance, mm. The latter
        is NaN unless the spring is linear and contacts lose energy.
    gaps : numpy.ndarray, shape (m,)
        Gaps of the map of quiet orbits, mm.
    displacement, modulus : numpy.ndarray, shape (m, n)
        Largest displacement of the quiet orbit (mm), and its largest multiplier of half a period
        in modulus; NaN where no quiet orbit was found.
    limit : float
        Largest displacement of a motion that counts as quiet, mm.
    motions, orbits : int
        Numbers of motions and of exact orbits computed.
    """

    frequencies: np.ndarray
    bare: np.ndarray
    worst: int
    rule_gap: float
    manifold_gap: float
    gaps: np.ndarray
    displacement: np.ndarray
    modulus: np.ndarray
    limit: float
    motions: int
    orbits: int

    @property
    def stable(self) -> np.ndarray:
        """Displacements of the stable quiet orbits, NaN elsewhere, shape (m, n)."""
        return np.where(self.modulus < 1, self.displacement, np.nan)

    @property
    def best(self) -> int | None:
        """Index of the gap of the least stable quiet orbit at the worst frequency, or None."""
        column = self.stable[:, self.worst]
        return int(np.nanargmin(column)) if np.isfinite(column).any() else None


def screen(task, *, workers=1, progress=None) -> Screening:
    """Take the first look at a task.

    Parameters
    ----------
    task : Task
    workers, progress
        As in `ensemble.settle`.

    Returns
    -------
    Screening
    """
    frequencies = task.grid
    bare = task.millimetres(
        np.array([balance_amplitudes(*task.system(1e-3, f)[::2])[-1] for f in frequencies])
    )
    worst = int(np.argmax(bare))
    rules = FLIGHT * np.array([task.rule_gap(f) for f in frequencies])
    gaps = np.geomspace(LEAST * rules.min(), MOST * rules.max(), GAPS)
    parameters = np.array([[task.packed(gap, f) for f in frequencies] for gap in gaps])
    columns = np.linspace(0, len(frequencies) - 1, SEED_FREQUENCIES).round().astype(int)
    cells = [
        (int(np.argmin(np.abs(gaps - share * rules[column]))), column)
        for column in sorted({*columns.tolist(), worst})
        for share in SEED_GAPS
    ]
    cases = [Case(gaps[row], frequencies[column]) for row, column in cells]
    found = run(task, cases, SEEDED, task.seed, workers=workers, progress=progress).random
    states = np.full((*parameters.shape[:2], 4), np.nan)
    for cell, records in zip(cells, found, strict=True):
        pairs = records[is_symmetric_pair(records)]
        if len(pairs):
            states[cell] = pairs["state"][np.argmin(pairs["maximum_displacement"])]
    quiet = follow_quiet_orbits(parameters, states)
    displacement, modulus = task.millimetres(quiet.displacement), np.abs(quiet.multiplier)
    limit = _limit(task, bare, np.where(modulus < 1, displacement, np.nan))
    return Screening(
        frequencies,
        bare,
        worst,
        1e3 * rules[worst],
        1e3 * _manifold_gap(task),
        1e3 * gaps,
        displacement,
        modulus,
        limit,
        found.size,
        int(np.isfinite(displacement).sum()),
    )


def _limit(task, bare, stable):
    """Return the largest displacement of a quiet motion, mm.

    If the task gives none: the geometric mean of the bare machine's displacement and of that of the
    least stable quiet orbit at the same frequency, so that a motion is quiet if it lies, on a
    logarithmic scale, nearer to the orbit. The frequency is that at which, of those with a stable
    quiet orbit, the bare machine moves most. Without any such orbit, half of the bare machine's
    displacement.
    """
    if task.displacement_limit is not None:
        return 1e3 * task.displacement_limit
    known = np.isfinite(stable).any(axis=0)
    if not known.any():
        return float(bare.max() / 2)
    column = np.argmax(np.where(known, bare, 0))
    return float(np.sqrt(bare[column] * np.nanmin(stable[:, column])))


def _manifold_gap(task):
    """Return the gap (m) of least response at the natural frequency by the manifold, or NaN."""
    machine = task.machine
    if machine.cubic_stiffness or not machine.linear_stiffness or task.restitution == 1:
        return np.nan
    oscillator, damper, frequency = task.system(1e-3, machine.natural_frequency)
    absorber = VibroImpactAbsorber(
        damper.mass_ratio, task.restitution, oscillator.damping / (2 * oscillator.linear_frequency)
    )
    static = oscillator.forcing_amplitude(frequency) / oscillator.linear_frequency**2
    return 2 * task.scales.to_si(absorber.optimum().clearance * static, "displacement")
