"""A design task: machine, loose mass, band of frequencies, tolerances and confidence.

Rule (18) of the paper is m2 w^2 (gap/2) = F, with the loose mass m2, the angular forcing frequency
w and the amplitude F of the force. A start is a random initial state. A motion is quiet if its
largest displacement is at most the quiet limit.
"""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property

import numpy as np

from impact_damper.data.shares import starts_needed
from impact_damper.design.band import checked_band, grid_over, resonance_of, resonances_within
from impact_damper.design.tolerances import NOMINAL, TOLERANCES, VARIED, checked_tolerances
from impact_damper.model.bounds import (
    MASS_RATIO_RANGE,
    RESTITUTION_RANGE,
    SEED_RANGE,
    STIFFNESS_RANGE,
    check_count,
    check_number,
    shown,
)
from impact_damper.model.checks import check_starts
from impact_damper.model.machine import Machine, MachineDamper
from impact_damper.model.packed import pack
from impact_damper.model.settling import Settling, check_settling
from impact_damper.model.units import check_si
from impact_damper.theory.free_oscillator import balance_amplitudes

# Least gap that a design considers, divided by the gap of rule (18).
LEAST_GAP = 0.3
# Comparisons of many gaps run motions for a shorter time. Their unit is the decay time, in which an
# unforced vibration of the machine decays by the factor e.
# PATIENT, LEAST_PATIENCE: a chaotic motion is stopped after PATIENT decay times, but not before
#     LEAST_PATIENCE cycles.
# LONG, LEAST_LIMIT: any other motion is stopped after LONG * PATIENT decay times, but not before
#     LEAST_LIMIT cycles.
PATIENT, LEAST_PATIENCE = 5, 100
LONG, LEAST_LIMIT = 6, 600
# Cycles over which a motion that has not settled is measured. With 50 cycles the largest peak of
# chaos would vary by a factor of two, so that shares of quiet starts would depend on chance.
WATCHED = 100
# Largest displacement of chaos in a long run, divided by the largest one in WATCHED cycles.
LATER = 1.5


def spread(values, count) -> np.ndarray:
    """Return at most `count` of the values, evenly spread, including the first and the last."""
    return values[np.unique(np.linspace(0, len(values) - 1, count).round().astype(int))]


@dataclass(frozen=True, kw_only=True)
class Task:
    """A design task; values are checked before anything is computed.

    Each physical value is a number in the SI unit, text with units, or a quantity of pint.

    Attributes
    ----------
    machine : Machine
    mass : float
        Loose mass, kg; at most the mass of the machine.
    band : tuple of float
        Least and greatest forcing frequency, Hz. The band must overlap the range `resonance`.
    restitution : float
    contact_stiffness : float
        N/m.
    frequencies : int
        Number of frequencies over the band.
    candidates : int
        Number of gaps that are compared.
    starts : int
        Random starts at each gap and frequency.
    tolerances : dict
        Largest relative deviations, keyed by names of VARIED.
    displacement_limit : float or None
        Quiet limit, the largest displacement of a quiet motion, m. If None, the design sets a limit
        (`screen`, `compare.coarse_comparison`).
    share : float
        Least share of starts that must lead to quiet motions, at 95 % confidence.
    seed : int
    settling : Settling
        Lengths and tolerances of runs. Motions that have not settled are measured over at least
        WATCHED cycles.

    Raises
    ------
    TypeError, ValueError
        If a value is out of range; the message names it, in SI units.
    """

    machine: Machine
    mass: float
    band: tuple
    restitution: float
    contact_stiffness: float
    frequencies: int = 41
    candidates: int = 12
    starts: int = 96
    tolerances: Mapping = field(default_factory=lambda: dict(TOLERANCES))
    displacement_limit: float | None = None
    share: float = 0.95
    seed: int = 1995
    settling: Settling | None = None

    def __post_init__(self):
        if not isinstance(self.machine, Machine):
            raise TypeError(f"machine = {shown(self.machine)}: must be a Machine")
        settle = object.__setattr__
        least = self.scales.to_si(MASS_RATIO_RANGE["least"], "mass")
        why = "mass of the machine: a heavier loose mass is no damper"
        mass = check_si("mass", self.mass, "mass", least=least, most=self.machine.mass, why=why)
        settle(self, "mass", mass)
        settle(
            self,
            "restitution",
            check_si("restitution", self.restitution, "number", **RESTITUTION_RANGE),
        )
        bounds = self.scales.range_to_si(STIFFNESS_RANGE, "stiffness")
        stiffness = check_si("contact_stiffness", self.contact_stiffness, "stiffness", **bounds)
        settle(self, "contact_stiffness", stiffness)
        settling = check_settling(self.settling)
        settling = replace(settling, watched=max(settling.watched, WATCHED), further=0)
        settle(self, "settling", settling)
        self._check_excitation()
        settle(self, "band", checked_band(self.machine, self.band, self.resonance))
        settle(self, "tolerances", checked_tolerances(self.tolerances))
        check_count("seed", self.seed, **SEED_RANGE)
        check_number("share", self.share, least=0.5, most=0.999)
        least = starts_needed(self.share)
        why = f"a share of {self.share:g} at 95 % confidence needs {least}, all quiet"
        check_count("starts", self.starts, least=least, most=10**5, why=why)
        check_count("frequencies", self.frequencies, least=3, most=10**4)
        check_count("candidates", self.candidates, least=4, most=1000)
        check_starts(self.starts, self.frequencies * self.candidates, least)
        if self.displacement_limit is not None:
            limit = check_si("displacement_limit", self.displacement_limit, "displacement", above=0)
            settle(self, "displacement_limit", limit)
        self._check_deviations()

    def _check_excitation(self):
        if not self.machine.static_force:
            raise ValueError(
                "machine: force = 0 N: must be greater than 0 N (without excitation nothing is to "
                "be damped)"
            )
        # With a moving base this raises ValueError if one oscillator cannot describe the force at
        # all frequencies.
        self.machine.oscillator()

    def _check_deviations(self):
        """Raise ValueError if a damper within the tolerances is not allowed."""
        least = self.restitution * (1 - self.tolerances.get("restitution", 0.0))
        if least < RESTITUTION_RANGE["least"]:
            raise ValueError(
                f"tolerances['restitution'] = {self.tolerances['restitution']:g}: the restitution "
                f"{self.restitution:g} may fall to {least:.3g}, must stay at least "
                f"{RESTITUTION_RANGE['least']:g} ({RESTITUTION_RANGE['why']})"
            )
        gap = LEAST_GAP * min(self.rule_gap(f) for f in self.band)
        least, most = (
            [1 + sign * self.tolerances.get(name, 0.0) for name in VARIED] for sign in (-1, 1)
        )
        for factors in (NOMINAL, least, most):
            self.damper(gap, factors).check_for(self.machine)
            for frequency in self.band:
                self.packed(gap, frequency, factors)

    @cached_property
    def resonance(self) -> tuple[float, float]:
        """Lowest and highest frequency at which the machine without damper resonates, Hz."""
        return resonance_of(self.machine)

    @cached_property
    def hurried(self) -> Settling:
        """Settling for comparisons of many gaps: shorter runs, a few decay times of the machine.

        After a short run fewer motions are quiet, because some become quiet slowly. Therefore
        `compare.run_until_sure` runs motions that are not quiet for the full time.
        """
        # Decay time of the machine in forcing cycles.
        decay = sum(self.band) * self.machine.mass / self.machine.viscous_damping
        patience = int(np.clip(PATIENT * decay, LEAST_PATIENCE, self.settling.patience))
        limit = int(np.clip(LONG * PATIENT * decay, LEAST_LIMIT, self.settling.limit))
        return replace(self.settling, patience=patience, limit=limit)

    @cached_property
    def resonances(self) -> list[float]:
        """Resonances within the band, Hz: without the loose mass, and with it fixed on."""
        return resonances_within(self.band, self.resonance, self.mass / self.machine.mass)

    @cached_property
    def grid(self) -> np.ndarray:
        """Frequencies over the band, Hz: evenly spaced, but some are moved onto `resonances`."""
        return grid_over(self.band, self.frequencies, self.resonances)

    @cached_property
    def bare(self) -> np.ndarray:
        """Largest displacement of the machine without damper by harmonic balance on `grid`, mm."""
        turning = self.scales.from_si(self.grid, "frequency")
        oscillators = [self.machine.oscillator(f) for f in self.grid]
        sizes = map(balance_amplitudes, oscillators, turning)
        return self.millimetres(np.array([ascending[-1] for ascending in sizes]))

    @property
    def worst_frequency(self) -> float:
        """Frequency of `grid` at which the machine without damper moves most, Hz."""
        return float(self.grid[np.argmax(self.bare)])

    def few(self, count, *others) -> np.ndarray:
        """Return some frequencies, Hz, ascending.

        They are `count` evenly spread frequencies of `grid`, the worst frequency, all resonances,
        and `others`.
        """
        resonances = np.intersect1d(self.grid, self.resonances)
        return np.union1d(spread(self.grid, count), [self.worst_frequency, *resonances, *others])

    @property
    def scales(self):
        """Scales of the machine."""
        return self.machine.scales

    def lasting(self, periods) -> Settling:
        """Return the settling with which a motion is run for `periods` unless it settles."""
        return replace(self.settling, patience=periods, limit=periods)

    def rule_gap(self, frequency) -> float:
        """Return the gap (m) by rule (18) of the paper at a frequency (Hz).

        If the force acted on the loose mass alone, the amplitude would be half of this gap.
        """
        force = self.machine.oscillator(frequency).forcing_amplitude(
            self.scales.from_si(frequency, "frequency")
        )
        return 2 * self.scales.to_si(force, "force") / (self.mass * (2 * math.pi * frequency) ** 2)

    def damper(self, gap, factors=NOMINAL) -> MachineDamper:
        """Return the damper with a gap (m).

        Gap, restitution and contact stiffness are multiplied by their `factors`, which are in the
        order of VARIED. A restitution above 1 becomes 1.
        """
        varied = dict(zip(VARIED, factors, strict=True))
        return MachineDamper(
            mass=self.mass,
            gap=gap * varied["gap"],
            restitution=min(1.0, self.restitution * varied["restitution"]),
            contact_stiffness=self.contact_stiffness * varied["contact_stiffness"],
        )

    def system(self, gap, frequency, factors=NOMINAL) -> tuple:
        """Return the oscillator, the damper and the frequency W, dimensionless.

        They are made dimensionless by the scales of the nominal machine, whatever the factors.
        """
        varied = dict(zip(VARIED, factors, strict=True))
        oscillator = self.machine.oscillator(frequency)
        oscillator = replace(
            oscillator,
            damping=oscillator.damping * varied["damping"],
            linear_frequency=oscillator.linear_frequency * math.sqrt(varied["stiffness"]),
            cubic=oscillator.cubic * varied["stiffness"],
            force=oscillator.force * self._force(frequency, varied),
            unbalance=oscillator.unbalance * varied["force"],
        )
        damper = self.damper(gap, factors).scaled(self.scales)
        return oscillator, damper, float(self.scales.from_si(frequency, "frequency"))

    def _force(self, frequency, varied):
        """Return the factor of the force.

        The force of a moving base also depends on the deviations of spring and dashpot, which
        transmit it.
        """
        machine = self.machine
        if machine.force is not None or machine.unbalance is not None:
            return varied["force"]
        angular = 2 * math.pi * frequency
        spring, dashpot = machine.linear_stiffness, machine.viscous_damping * angular
        deviated = math.hypot(spring * varied["stiffness"], dashpot * varied["damping"])
        return varied["force"] * deviated / math.hypot(spring, dashpot)

    def packed(self, gap, frequency, factors=NOMINAL) -> np.ndarray:
        """Return the packed parameters of `system`."""
        return pack(*self.system(gap, frequency, factors))

    def millimetres(self, displacement):
        """Return dimensionless displacements in mm, the unit of datasets."""
        return 1e3 * self.scales.to_si(displacement, "displacement")

    def describe(self) -> dict:
        """Return the values of the task except those of the machine, keyed by name, in SI units."""
        kept = ("mass", "restitution", "contact_stiffness", "frequencies", "candidates", "starts")
        found = {name: getattr(self, name) for name in (*kept, "share", "seed")}
        return found | {
            "band": list(self.band),
            "tolerances": dict(self.tolerances),
            "displacement_limit": self.displacement_limit,
            "later_displacement": LATER,
            "settling": asdict(self.settling),
            "compared_settling": asdict(self.hurried),
        }
