"""The task of a design: machine, loose mass, contact, band of frequencies, tolerances, effort.

Values are in SI units, or in mm where stated. Rule (18) of the paper gives the gap
2 F/(m2 w^2): F is the amplitude of the force, m2 the loose mass, w the angular frequency.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property

import numpy as np
import xarray as xr

from impact_damper.data.datasets import SOURCE, shown_variable
from impact_damper.data.shares import starts_needed
from impact_damper.model import bounds
from impact_damper.model.exit_rules import NO_TENSION
from impact_damper.model.hertz import HertzContact
from impact_damper.model.machine import (
    EXCITATIONS,
    Machine,
    MachineDamper,
    TunedAbsorber,
    describe_si,
    mounting,
)
from impact_damper.model.packed import pack
from impact_damper.model.settling import Settling, check_settling
from impact_damper.model.text import with_unit
from impact_damper.model.units import absolute_value, check_si
from impact_damper.theory.free_oscillator import balance_amplitudes, free_folds, maximum_response

# Names of the values that may deviate from their nominal values. The last three are of the machine.
VARIED = tuple("gap restitution contact_stiffness gravity friction stiffness damping force".split())
NOMINAL = (1.0,) * len(VARIED)  # factors by which nominal values are multiplied, here all 1
TOLERANCES = {"gap": 0.2}  # largest relative deviations if none are given
SIDES = ["lower", "upper"]
# A result in addition to the decision is left out if one of these errors occurs in its computation.
NUMERICAL = (ArithmeticError, ValueError, IndexError, np.linalg.LinAlgError)
MOST_DEVIATION = 0.9  # largest relative deviation that is allowed
# Value -> physical quantity of its tolerance, if the tolerance is given with a unit and not as a
# fraction. `force` is not listed: its quantity depends on the kind of excitation.
ABSOLUTE = {
    "gap": "displacement",
    "contact_stiffness": "stiffness",
    "stiffness": "stiffness",
    "damping": "damping",
}
# Rule (18) gives a gap at each frequency of the band. r is the smallest of these gaps, and g is the
# greatest gap that a design considers. The least gap that it considers is LEAST_GAP x min(r, g).
LEAST_GAP = 0.15
# Rule (18) gives a gap at each frequency of the band. If the machine without damper escapes at all
# frequencies, the greatest gap that a design considers is ESCAPING x the largest of these gaps.
ESCAPING = 4.0
# An absorber is tuned for all forcing frequencies from ABSORBED[0] x f1 to ABSORBED[1] x f2. Among
# the ends of the band and the ends of `Task.resonance`, f1 is the lowest and f2 the highest.
ABSORBED = 0.5, 2.0
# In the first run of a motion, `Settling.patience` is at most max(PATIENT x D, LEAST_PATIENCE), and
# `Settling.limit` is at most max(LONG x PATIENT x D, LEAST_LIMIT). D is the number of forcing
# cycles in which an unforced vibration of the machine falls to 1/e.
PATIENT, LEAST_PATIENCE = 5, 100
LONG, LEAST_LIMIT = 6, 600
WATCHED = 100  # least number of forcing cycles over which an unsettled motion is measured


def labelled(values, **coordinates) -> xr.Dataset:
    """Return a dataset of named arrays, with units and descriptions. Displacements are in mm."""
    made = {name: shown_variable(name, value) for name, value in values.items()}
    known = {name: shown_variable(name, value) for name, value in coordinates.items()}
    return xr.Dataset(made, known, {"source": SOURCE})


@bounds.names_arguments
@dataclass(frozen=True, kw_only=True)
class Effort:
    """How much a design computes; more effort gives a finer and surer design.

    Attributes
    ----------
    frequencies : int
        Number of frequencies over the band. Each resonance replaces the nearest frequency.
    candidates : int
        Largest number of gaps in each round that follows the first search over all gaps.
    starts : int
        Number of random starts (initial states) with which a gap is confirmed at each frequency.
    seed : int
        Seed of the random starts.
    settling : Settling, optional
        How long motions are run, and how accurately.
    workers : int
        Number of threads. The result does not depend on this number.

    Raises
    ------
    TypeError, ValueError
        If a value has a wrong type or is out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> idm.Effort(starts=200).frequencies
    41
    """

    frequencies: int = 41
    candidates: int = 12
    starts: int = 96
    seed: int = 1995
    settling: Settling | None = None
    workers: int = 1

    def __post_init__(self):
        bounds.check_count("frequencies", self.frequencies, least=3, most=10**4)
        bounds.check_count("candidates", self.candidates, least=4, most=1000)
        bounds.check_count("starts", self.starts, least=1, most=10**5)
        bounds.check_count("seed", self.seed, **bounds.SEED_RANGE)
        bounds.check_count("workers", self.workers, least=1, most=1024)
        settling = check_settling(self.settling)
        settling = replace(settling, watched=max(settling.watched, WATCHED), further=0)
        object.__setattr__(self, "settling", settling)


@dataclass(frozen=True, kw_only=True)
class Task:
    """A task of `design_damper` or `evaluate_damper`, checked before anything is computed.

    `gap` (m) is the gap of an existing damper, or None if a gap is to be found. `contact_stiffness`
    (N/m) follows from `contact`. `gravity` along the gap (m/s^2) and `friction` (N) follow from
    `mount` (see `impact_damper.model.machine.mounting`).
    """

    machine: Machine
    mass: float
    band: tuple
    restitution: float
    contact: float | HertzContact
    tolerances: Mapping = field(default_factory=lambda: dict(TOLERANCES))
    displacement_limit: float | None = None
    share: float = 0.95
    gap: float | None = None
    mount: Mapping | None = None
    exit_rule: str = NO_TENSION
    absorber: TunedAbsorber | None = None
    effort: Effort = field(default_factory=Effort)
    contact_stiffness: float = field(init=False)
    gravity: float = field(init=False)
    friction: float = field(init=False)

    def __post_init__(self):
        if not isinstance(self.machine, Machine):
            raise TypeError(f"machine = {bounds.shown(self.machine)}: must be a Machine")
        if not isinstance(self.effort, Effort):
            raise TypeError(f"effort = {bounds.shown(self.effort)}: must be an Effort")
        least = self.scales.to_si(bounds.MASS_RATIO_RANGE["least"], "mass")
        why = "mass of the machine: a heavier loose mass is no damper"
        mass = check_si("mass", self.mass, "mass", least=least, most=self.machine.mass, why=why)
        self._set("mass", mass)
        for name, value in mounting(mass, **(self.mount or {})).items():
            self._set(name, value)
        restitution, limits = self.restitution, bounds.RESTITUTION_RANGE
        self._set("restitution", check_si("restitution", restitution, "number", **limits))
        self._check_excitation()
        self._set("band", checked_band(self.machine, self.band, self.resonance))
        self._set("contact_stiffness", self._stiffness())
        self._set("tolerances", self._checked_tolerances())
        bounds.check_number("share", self.share, least=0.5, most=0.999)
        least, effort = starts_needed(self.share), self.effort
        why = f"a share of {self.share:g} at 95 % confidence needs {least}"
        bounds.check_count("starts", effort.starts, least=least, most=10**5, why=why)
        bounds.check_starts(effort.starts, effort.frequencies * effort.candidates, least)
        if self.displacement_limit is not None:
            why = "the machine without damper moves no further"
            self._check_length("displacement_limit", 1e-3 * float(self.bare.max()), why)
        if self.gap is not None:
            most = 2 * max(1e-3 * float(self.bare.max()), self.machine.resonant_displacement)
            why = "full play; the machine without damper does not touch the walls of a larger gap"
            self._check_length("gap", most, why)
        if isinstance(self.absorber, Mapping):
            self._set("absorber", TunedAbsorber(**self.absorber))
        if self.absorber is not None and not isinstance(self.absorber, TunedAbsorber):
            given = bounds.shown(self.absorber)
            raise TypeError(f"absorber = {given}: must have mass, stiffness and damping")
        self._check_deviations()

    def _set(self, name, value):
        object.__setattr__(self, name, value)

    def _check_length(self, name, most, why):
        limits = {"most": most, "why": why} if math.isfinite(most) else {}
        length = check_si(name, getattr(self, name), "displacement", above=0, **limits)
        self._set(name, length)

    def _stiffness(self):
        limits = self.scales.range_to_si(bounds.STIFFNESS_RANGE, "stiffness")
        stiffness = self.contact
        if isinstance(stiffness, HertzContact):
            middle = sum(self.band) / 2
            reduced = self.machine.mass * self.mass / (self.machine.mass + self.mass)
            stiffness = stiffness.stiffness(2 * self.rule_gap(middle) * middle, reduced)
        return check_si("contact", stiffness, "stiffness", **limits)

    def _check_excitation(self):
        if not self.machine.static_force:
            raise ValueError(
                "machine: force = 0 N: must be greater than 0 N (without excitation nothing is to "
                "be damped)"
            )

    def _check_deviations(self):
        gap = self.gap or 1e-3 * self.gap_span[0]
        widths = self.deviations(1e3 * gap)
        least = self.restitution * (1 - self.tolerances.get("restitution", 0.0))
        if least < bounds.RESTITUTION_RANGE["least"]:
            raise ValueError(
                f"tolerances['restitution'] = {self.tolerances['restitution']:g}: the restitution "
                f"{self.restitution:g} may fall to {least:.3g}, must stay at least "
                f"{bounds.RESTITUTION_RANGE['least']:g} ({bounds.RESTITUTION_RANGE['why']})"
            )
        for factors in (NOMINAL, 1 - widths, 1 + widths):
            self.damper(gap, factors).check_for(self.machine)
            for frequency in self.band:
                self.packed(gap, frequency, factors)

    def _checked_tolerances(self):
        if not isinstance(self.tolerances, Mapping):
            raise TypeError(f"tolerances = {bounds.shown(self.tolerances)}: must be a dictionary")
        machine, found = self.machine, {}
        given = next(name for name in EXCITATIONS if getattr(machine, name) is not None)
        excitation = machine.__dataclass_fields__[given].metadata["quantity"]
        quantities = ABSOLUTE | {"force": excitation}
        nominal = {
            "contact_stiffness": self.contact_stiffness,
            "stiffness": machine.linear_stiffness,
            "damping": machine.viscous_damping,
            "force": getattr(machine, given),
        }
        for name, value in self.tolerances.items():
            if name not in VARIED:
                known = ", ".join(VARIED)
                raise ValueError(f"tolerances = {bounds.shown(name)}: must be of {known}")
            told = f"tolerances[{name!r}]"
            width = absolute_value(value, quantities.get(name))
            if width is not None and name == "gap":
                found[name] = f"{bounds.check_number(told, width, above=0)!r} m"
                continue
            if width is not None and nominal[name]:
                value = width / nominal[name]
            why = "relative deviation: at 1 the nominal value would become 0"
            found[name] = check_si(told, value, "number", least=0, most=MOST_DEVIATION, why=why)
        return found

    @cached_property
    def gap_tolerance(self) -> tuple[float, float]:
        """Tolerance of the gap: (fraction of the gap, length in mm). One of the two is 0."""
        value = self.tolerances.get("gap", 0.0)
        return (value, 0.0) if isinstance(value, float) else (0.0, 1e3 * float(value.split()[0]))

    def gap_ends(self, gaps) -> tuple:
        """Return the least and the greatest gap within the tolerance of each nominal gap, mm."""
        share, width = self.gap_tolerance
        reach = np.minimum(share + width / gaps, MOST_DEVIATION)
        return gaps * (1 - reach), gaps * (1 + reach)

    def deviations(self, gap) -> np.ndarray:
        """Return the largest relative deviation of each value in VARIED, for a nominal gap (mm)."""
        share, width = self.gap_tolerance
        others = [self.tolerances.get(name, 0.0) for name in VARIED[1:]]
        return np.array([min(share + width / gap, MOST_DEVIATION), *others])

    @cached_property
    def gap_span(self) -> tuple[float, float]:
        """Least and greatest gap that a design considers, mm."""
        rules = np.array([1e3 * self.rule_gap(f) for f in self.grid])
        sizes = self.bare[np.isfinite(self.bare)]
        # In a gap wider than `most`, no wall reaches a loose mass that rests in the middle.
        most = 2 * sizes.max() if len(sizes) else ESCAPING * rules.max()
        if self.gravity:  # the machine may throw the loose mass up to the opposite wall
            speeds = 1e-3 * self.bare * 2 * math.pi * self.grid
            fastest = np.max(speeds[np.isfinite(speeds)], initial=0)
            most += 1e3 * fastest**2 / 2 / abs(self.gravity)
        return LEAST_GAP * min(rules.min(), most), most

    @cached_property
    def resonance(self) -> tuple[float, float]:
        """Lowest and highest frequency at which the machine without damper resonates, Hz."""
        return resonance_of(self.machine)

    @cached_property
    def hurried(self) -> Settling:
        """Settings of the first run of each motion. PATIENT says how long this run may last."""
        full = self.effort.settling
        decay = sum(self.band) * self.machine.mass / self.machine.viscous_damping
        patience = int(np.clip(PATIENT * decay, LEAST_PATIENCE, full.patience))
        limit = int(np.clip(LONG * PATIENT * decay, LEAST_LIMIT, full.limit))
        return replace(full, patience=patience, limit=limit, watched=1)

    @cached_property
    def resonances(self) -> list[float]:
        """Resonances in the band (Hz): machine alone, and machine with the loose mass fixed."""
        ratio = math.sqrt(1 + self.mass / self.machine.mass)
        found = [each for end in self.resonance for each in (end / ratio, end)]
        return [each for each in found if self.band[0] < each < self.band[1]]

    @cached_property
    def grid(self) -> np.ndarray:
        """Evenly spaced frequencies (Hz). A resonance replaces the frequency nearest to it."""
        values = np.linspace(*self.band, self.effort.frequencies)
        for frequency in self.resonances:
            values[1 + np.argmin(np.abs(values[1:-1] - frequency))] = frequency
        return np.unique(values)

    @cached_property
    def bare(self) -> np.ndarray:
        """Largest displacement without damper at each frequency of `grid`, mm."""
        return self.bare_at(self.grid)

    def bare_at(self, frequencies) -> np.ndarray:
        """Return the largest displacement without damper (mm) at each frequency (Hz)."""
        return self.millimetres(np.array([sizes[-1] for sizes in self._balances(frequencies)]))

    @property
    def migration_offer(self) -> str:
        """`yes` if the machine without damper has two motions at some frequency, otherwise `no`."""
        return "yes" if any(len(sizes) > 1 for sizes in self._balances(self.grid)) else "no"

    def _balances(self, frequencies) -> list:
        oscillator = self.machine.oscillator()
        turning = self.scales.from_si(np.asarray(frequencies), "frequency")
        return [balance_amplitudes(oscillator, w) for w in turning]

    @property
    def absorber_band(self) -> tuple[float, float]:
        """Range of frequencies (Hz) over which an absorber is tuned for comparison."""
        low, high = self.resonance
        return ABSORBED[0] * min(low, self.band[0]), ABSORBED[1] * max(high, self.band[1])

    @property
    def worst_frequency(self) -> float:
        """Frequency of `grid` at which the machine without damper moves most, Hz."""
        return float(self.grid[np.argmax(self.bare)])

    def few(self, count, *others) -> np.ndarray:
        """Return `count` evenly spread frequencies of `grid`, and further frequencies (Hz).

        The further ones are `worst_frequency`, `resonances`, `others`. No frequency occurs twice.
        """
        places = np.linspace(0, len(self.grid) - 1, count).round().astype(int)
        resonances = np.intersect1d(self.grid, self.resonances)
        return np.union1d(self.grid[places], [self.worst_frequency, *resonances, *others])

    @property
    def scales(self):
        """Scales of the machine, which convert SI values to dimensionless values and back."""
        return self.machine.scales

    def rule_gap(self, frequency) -> float:
        """Return the gap (m) that rule (18) of the paper gives at a frequency (Hz)."""
        turning = self.scales.from_si(frequency, "frequency")
        force = self.machine.oscillator().forcing_amplitude(turning)
        return 2 * self.scales.to_si(force, "force") / (self.mass * (2 * math.pi * frequency) ** 2)

    def damper(self, gap, factors=NOMINAL) -> MachineDamper:
        """Return the damper with a gap (m). `factors` multiply the values named in VARIED."""
        varied = dict(zip(VARIED, factors, strict=True))
        return MachineDamper(
            mass=self.mass,
            gap=gap * varied["gap"],
            restitution=min(1.0, self.restitution * varied["restitution"]),
            contact_stiffness=self.contact_stiffness * varied["contact_stiffness"],
            gravity=self.gravity * varied["gravity"],
            friction=self.friction * varied["friction"],
            exit_rule=self.exit_rule,
        )

    def system(self, gap, frequency, factors=NOMINAL) -> tuple:
        """Return dimensionless oscillator, damper and frequency (`gap` in m, `frequency` in Hz)."""
        varied = dict(zip(VARIED, factors, strict=True))
        oscillator = self.machine.oscillator()
        oscillator = replace(
            oscillator,
            damping=oscillator.damping * varied["damping"],
            linear_frequency=oscillator.linear_frequency * math.sqrt(varied["stiffness"]),
            cubic=oscillator.cubic * varied["stiffness"],
            force=oscillator.force * varied["force"],
            unbalance=oscillator.unbalance * varied["force"],
        )
        damper = self.damper(gap, factors).scaled(self.scales)
        return oscillator, damper, float(self.scales.from_si(frequency, "frequency"))

    def packed(self, gap, frequency, factors=NOMINAL) -> np.ndarray:
        """Return oscillator, damper and frequency (see `system`) as one array of numbers."""
        return pack(*self.system(gap, frequency, factors))

    def millimetres(self, displacement):
        """Convert dimensionless displacements to mm, the unit of displacements in datasets."""
        return 1e3 * self.scales.to_si(displacement, "displacement")

    def describe(self) -> dict:
        """Return all values that determine the design, keyed by name, in SI units."""
        effort = asdict(self.effort)
        del effort["workers"]
        return effort | {
            "machine": describe_si(self.machine),
            "mass": self.mass,
            "band": list(self.band),
            "restitution": self.restitution,
            "contact": repr(self.contact),
            "contact_stiffness": self.contact_stiffness,
            "tolerances": dict(self.tolerances),
            "displacement_limit": self.displacement_limit,
            "share": self.share,
            "gap": self.gap,
            "gravity": self.gravity,
            "friction": self.friction,
            "exit_rule": self.exit_rule,
            "absorber": self.absorber and asdict(self.absorber),
            "compared_settling": asdict(self.hurried),
        }


def resonance_of(machine) -> tuple[float, float]:
    """Return the lowest and the highest frequency (Hz) at which the machine alone resonates."""
    natural = machine.natural_frequency
    oscillator = machine.oscillator()
    found = [point.frequency for point in free_folds(oscillator)]
    try:
        found.append(maximum_response(oscillator).frequency)
    except ValueError:
        pass  # no peak: heavy damping, or a motion that passes the barrier of a softening spring
    ends = [*machine.scales.to_si(np.array(found), "frequency")]
    if natural or not ends:
        ends.append(natural)
    return float(min(ends)), float(max(ends))


def checked_band(machine, band, resonance) -> tuple[float, float]:
    """Return both ends of a band (Hz). The band must overlap the range `resonance` (Hz)."""
    if not isinstance(band, Sequence | np.ndarray) or isinstance(band, str) or len(band) != 2:
        raise ValueError(
            f"band = {bounds.shown(band)}: must be least and greatest frequency (how many "
            "frequencies between them are computed is `frequencies` of the effort)"
        )
    ends = tuple(machine.check_frequency(f"band[{i}]", value) for i, value in enumerate(band))
    low, high = resonance
    if not ends[0] < ends[1] or ends[1] < low or ends[0] > high:
        given = " to ".join(with_unit(end, "Hz") for end in ends)
        where = f"{low:.4g} Hz" if high - low < 1e-3 * low else f"{low:.4g} to {high:.4g} Hz"
        raise ValueError(
            f"band = {given}: must ascend and reach into the resonance of the machine, at "
            f"{where} (away from its resonance a machine needs no damper)"
        )
    return ends
