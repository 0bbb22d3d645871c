"""A machine with spring and excitation, its impact damper, and a tuned absorber, in SI units."""

import math
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property

from impact_damper.model import bounds
from impact_damper.model.exit_rules import NO_TENSION
from impact_damper.model.identification import from_response, from_ring_down
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.text import with_unit
from impact_damper.model.units import Scales, check_si, convert, optional, physical

EXCITATIONS = ("force", "base_displacement", "base_acceleration", "unbalance")
GRAVITY = 9.81  # acceleration of gravity, m/s^2
ANGLES = {"least": 0, "most": 1.5708}  # range of the inclination of a gap, radian
VERTICAL = 1.5707  # least inclination of a vertical gap, radian
FRICTIONS = {"least": 0, "most": 10}  # range of a coefficient of friction
# Keys of the damper in a machine's file that are passed to the function `mounting`.
MOUNT = ("inclination", "friction_coefficient", "normal_force")
GRAVITIES = {"least": -1e3, "most": 1e3}  # range of gravity along the gap, m/s^2
MOST_DAMPING = 0.99


class Derived(float):
    """Marks a field that a machine has computed from other fields. The user has not given it."""


@bounds.names_arguments
@dataclass(frozen=True, kw_only=True)
class MachineDamper:
    """A loose mass in a gap of a machine, in SI units. `Machine.damper` makes and checks it."""

    mass: float = physical("mass", "loose mass", above=0)
    gap: float = physical("clearance", "full play of the loose mass from wall to wall", above=0)
    restitution: float = physical(
        "number", "coefficient of restitution", **bounds.RESTITUTION_RANGE, default=1.0
    )
    contact_stiffness: float = physical("stiffness", "stiffness of the contact", above=0)
    gravity: float = physical(
        "acceleration", "component of gravity along the gap", **GRAVITIES, default=0.0
    )
    friction: float = physical(
        "force", "Coulomb friction of the loose mass on its floor", least=0, most=1e9, default=0.0
    )
    exit_rule: str = NO_TENSION

    def __post_init__(self):
        convert(self)

    def check_for(self, machine):
        """Raise ValueError if a value of the damper is out of the range allowed for a machine.

        The gap must exceed twice the compression of a contact under the force F m2/(m1 + m2). F is
        `static_force` of the machine, m1 the machine's mass, and m2 the loose mass.
        """
        scales = machine.scales
        gaps = scales.range_to_si(bounds.CLEARANCE_RANGE, "gap")
        check_si("mass", self.mass, "mass", **scales.range_to_si(bounds.MASS_RATIO_RANGE, "mass"))
        check_si("gap", self.gap, "clearance", **gaps)
        limits = scales.range_to_si(bounds.STIFFNESS_RANGE, "stiffness")
        check_si("contact_stiffness", self.contact_stiffness, "stiffness", **limits)
        share = self.mass / (machine.mass + self.mass)
        play = 2 * share * machine.static_force / self.contact_stiffness
        why = "static play: compression of the contacts on both sides"
        check_si("gap", self.gap, "clearance", above=play, why=why)

    def scaled(self, scales) -> Damper:
        """Return the dimensionless damper. `scales` are the scales of its machine."""
        return Damper(
            mass_ratio=scales.from_si(self.mass, "mass"),
            clearance=scales.from_si(self.gap, "gap"),
            restitution=self.restitution,
            contact_stiffness=scales.from_si(self.contact_stiffness, "stiffness"),
            gravity=scales.from_si(self.gravity, "acceleration"),
            friction=scales.from_si(self.friction / self.mass, "acceleration"),
            exit_rule=self.exit_rule,
        )

    def __str__(self):
        return (
            f"mass {with_unit(self.mass, 'kg')}, gap {with_unit(1e3 * self.gap, 'mm')} (full "
            f"play), restitution {self.restitution:g}, contact stiffness "
            f"{with_unit(self.contact_stiffness, 'N/m')}, gravity "
            f"{with_unit(self.gravity, 'm/s^2')}, friction {with_unit(self.friction, 'N')}"
        )


@bounds.names_arguments
@dataclass(frozen=True, kw_only=True)
class Machine:
    """A mass on a spring and a dashpot with its excitation, in SI units.

    Each value is a number in the SI unit, text with units such as "12 kg", or a quantity of pint;
    the fields hold numbers. The restoring force at the deflection x is
    linear_stiffness x + cubic_stiffness x^3, where x is 0 at rest under the machine's weight. The
    natural frequency may be given in place of the linear stiffness. The damping must be given by
    one of damping_ratio, quality_factor and damping. The excitation must be given by one of force,
    base_displacement, base_acceleration and unbalance. An unbalance exerts a force whose amplitude
    is w^2 times `unbalance`, at the angular frequency w. On a moving base, displacements are
    relative to the base, and the base's acceleration acts on both masses. Functions that take a
    machine take frequencies in Hz and states in m, m/s. Their datasets are in mm, Hz, N, m/s and s.

    Raises
    ------
    TypeError, ValueError
        If a value is missing or out of range, or if two values exclude each other.

    Examples
    --------
    >>> machine = Machine(
    ...     mass="12 kg", linear_stiffness=2e5, damping_ratio="0.5 %", force="40 N"
    ... )
    >>> machine.damper(mass="0.6 kg", gap="3 mm", restitution=0.8, contact_stiffness=2e7).gap
    0.003
    """

    mass: float = physical("mass", "mass without the loose mass", least=1e-15, most=1e15)
    linear_stiffness: float = physical(
        "stiffness", "linear stiffness of the spring", least=0, most=1e30, default=0.0
    )
    cubic_stiffness: float = physical(
        "cubic_stiffness",
        "cubic stiffness of the spring, negative if the spring softens",
        least=-1e30,
        most=1e30,
        default=0.0,
    )
    natural_frequency: float | None = optional(
        "frequency",
        "frequency of small undamped vibrations (in place of `linear_stiffness`)",
        above=0,
        most=1e15,
    )
    damping_ratio: float | None = optional(
        "number",
        "damping divided by the critical damping (give this or one of the next two keys)",
        above=0,
        most=MOST_DAMPING,
        why="at 1, critical damping, nothing vibrates; 1 per cent is 0.01 or '1 %'",
    )
    quality_factor: float | None = optional(
        "number", "1 / (2 damping_ratio)", above=0.5 / MOST_DAMPING
    )
    damping: float | None = optional("damping", "coefficient of the dashpot", above=0)
    force: float | None = optional(
        "force",
        "amplitude of the force (give this or one of the next three keys)",
        least=0,
        most=1e15,
    )
    base_displacement: float | None = optional(
        "displacement", "amplitude with which the base moves", above=0, most=1e3
    )
    base_acceleration: float | None = optional(
        "acceleration", "amplitude of the base's acceleration", above=0, most=1e9
    )
    unbalance: float | None = optional(
        "unbalance", "mass times eccentricity of a rotating unbalance", above=0, most=1e15
    )

    from_ring_down = classmethod(from_ring_down)
    from_response = classmethod(from_response)

    def __post_init__(self):
        for each in fields(self):
            if isinstance(getattr(self, each.name), Derived):
                object.__setattr__(self, each.name, each.default)
        convert(self)
        self._derive()
        self._check_spring()
        self._check_damping()
        given = [name for name in EXCITATIONS if getattr(self, name) is not None]
        if len(given) != 1:
            names = " and ".join(given) or "none of them"
            raise ValueError(
                f"excitation = {names}: must be one of {', '.join(EXCITATIONS)}, and one alone"
            )

    def _derive(self):
        if self.natural_frequency is None:
            found = math.sqrt(self.linear_stiffness / self.mass) / (2 * math.pi)
            object.__setattr__(self, "natural_frequency", Derived(found))
        elif self.linear_stiffness:
            raise ValueError(
                f"natural_frequency = {with_unit(self.natural_frequency, 'Hz')}: must be left out "
                "with linear_stiffness, from which it follows"
            )
        else:
            found = self.mass * (2 * math.pi * self.natural_frequency) ** 2
            most = self.__dataclass_fields__["linear_stiffness"].metadata["bounds"]["most"]
            check_si("natural_frequency: stiffness", found, "stiffness", above=0, most=most)
            object.__setattr__(self, "linear_stiffness", Derived(found))
        if self.quality_factor is not None and self.damping_ratio is None and self.damping is None:
            object.__setattr__(self, "damping_ratio", Derived(0.5 / self.quality_factor))
        elif self.quality_factor is not None:
            raise ValueError(
                f"quality_factor = {self.quality_factor:g}: must be left out with damping_ratio or "
                "damping, from which it follows"
            )

    def _check_spring(self):
        if self.linear_stiffness == 0 and self.cubic_stiffness <= 0:
            raise ValueError(
                f"linear_stiffness = {with_unit(0.0, 'N/m')}: must be greater than 0 N/m with "
                f"cubic_stiffness = {with_unit(self.cubic_stiffness, 'N/m^3')} (without a force "
                "that restores it the machine drifts away)"
            )

    def _check_damping(self):
        if (self.damping_ratio is None) == (self.damping is None):
            raise ValueError(
                "damping: must be given, or damping_ratio or quality_factor in its place, and one "
                "alone"
            )
        critical = 2 * math.sqrt(self.linear_stiffness * self.mass)
        if self.damping_ratio is not None and not critical:
            raise ValueError(
                f"damping_ratio = {self.damping_ratio:g}: must be left out without linear_stiffness"
                ", for damping in N s/m (there is no critical damping)"
            )
        if self.damping is not None and critical:
            why = f"{MOST_DAMPING:g} of critical damping, near which nothing vibrates"
            check_si("damping", self.damping, "damping", most=MOST_DAMPING * critical, why=why)
        limits = self.scales.range_to_si(bounds.DAMPING_RANGE, "damping")
        check_si("damping", self.viscous_damping, "damping", **limits)

    @property
    def viscous_damping(self) -> float:
        """Coefficient c of the dashpot, N s/m."""
        if self.damping is not None:
            return self.damping
        return 2 * self.damping_ratio * math.sqrt(self.linear_stiffness * self.mass)

    @cached_property
    def scales(self) -> Scales:
        """Scales with which the dimensionless equations describe the machine.

        The scale of length is the geometric mean of `resonant_displacement` and of the deflection
        that `static_force` causes. With this scale, dimensionless displacements are of order 1.
        The scale of time makes omega_l^2 + |k3| = 1.
        """
        stiffness, cubic = self.linear_stiffness, abs(self.cubic_stiffness)
        length = math.sqrt(self._static_deflection() * self.resonant_displacement)
        time = math.sqrt(self.mass / (stiffness + cubic * length**2))
        return Scales(length, time, self.mass, si=True)

    def _static_deflection(self):
        stiffness, cubic = self.linear_stiffness, abs(self.cubic_stiffness)
        if self.force:
            return static_deflection(self.force, stiffness, cubic)
        if self.unbalance is not None:
            return self.unbalance / self.mass
        if self.base_displacement is not None:
            return self.base_displacement
        if self.base_acceleration is not None:
            return static_deflection(self.mass * self.base_acceleration, stiffness, cubic)
        return math.sqrt(stiffness / cubic) if stiffness and cubic else 1e-3

    @property
    def resonant_displacement(self) -> float:
        """Estimated displacement (m) at resonance: static deflection times max(1, m w/c).

        m is the machine's mass, c is `viscous_damping`, and w the angular frequency at which m w^2
        is the secant stiffness of the spring at the static deflection.
        """
        static = self._static_deflection()
        stiffness = self.linear_stiffness + abs(self.cubic_stiffness) * static**2
        return static * max(1.0, math.sqrt(stiffness * self.mass) / self.viscous_damping)

    @property
    def static_force(self) -> float:
        """Static force (N) that stands for the excitation.

        It is `force`, or the mass times `base_acceleration`. If neither is given, it is the force
        of the spring at the deflection `base_displacement`, or at the deflection `unbalance`/mass.
        """
        if self.force is not None:
            return self.force
        x = self._static_deflection()
        return self.linear_stiffness * x + abs(self.cubic_stiffness) * x**3

    def oscillator(self) -> Oscillator:
        """Return the machine as a dimensionless `Oscillator`, which keeps the machine's scales."""
        scales = self.scales
        force, unbalance = self.forcing
        return Oscillator(
            damping=scales.from_si(self.viscous_damping, "damping"),
            linear_frequency=math.sqrt(scales.from_si(self.linear_stiffness, "stiffness")),
            cubic=scales.from_si(self.cubic_stiffness, "cubic_stiffness"),
            force=scales.from_si(force, "force"),
            unbalance=scales.from_si(unbalance, "unbalance"),
            base=float(self.is_based),
            scales=scales,
        )

    @property
    def is_based(self) -> bool:
        """Whether the base moves, so that displacements of the machine are relative to the base."""
        return self.base_displacement is not None or self.base_acceleration is not None

    @property
    def forcing(self) -> tuple[float, float]:
        """F (N) and U (kg m). At the angular frequency w the forcing amplitude is F + U w^2."""
        if self.is_based:
            moved = self.base_displacement or 0.0
            return self.mass * (self.base_acceleration or 0.0), self.mass * moved
        return self.force or 0.0, self.unbalance or 0.0

    def check_frequency(self, name, value) -> float:
        """Return a forcing frequency in Hz, or raise an error if it is out of range."""
        limits = self.scales.range_to_si(bounds.FREQUENCY_RANGE, "frequency")
        return check_si(name, value, "frequency", **limits)

    def damper(self, *, mass, gap=None, clearances=None, mount=None, **contact) -> MachineDamper:
        """Return a damper for this machine.

        Parameters
        ----------
        mass : float, str or pint.Quantity
            Loose mass, kg.
        gap : float, str or pint.Quantity
            Full play of the loose mass from wall to wall, m.
        clearances : sequence of 2 floats, str or pint.Quantity
            In place of `gap`, the distances (m) from the loose mass at rest to both walls. Motions
            depend on their sum only, because no spring holds the loose mass between the walls. Z2
            is measured from the middle of the gap, also if both distances differ.
        mount : dict, optional
            Arguments of `mounting`, such as {"inclination": "90 deg"}.
        contact
            The arguments contact_stiffness, restitution and exit_rule of `MachineDamper`.

        Raises
        ------
        TypeError, ValueError
            If a value is out of range, or does not fit this machine.
        """
        if (gap is None) == (clearances is None):
            raise ValueError(
                "gap: must be given, the full play, or clearances in its place, and not both"
            )
        if gap is None:
            sides = zip(("clearances[0]", "clearances[1]"), clearances, strict=True)
            gap = sum(check_si(name, value, "clearance", least=0) for name, value in sides)
        damper = MachineDamper(mass=mass, gap=gap, **mounting(mass, **(mount or {})), **contact)
        damper.check_for(self)
        return damper


def mounting(
    mass,
    *,
    inclination=None,
    gravity=None,
    friction_coefficient=0.0,
    normal_force=None,
    friction=None,
) -> dict:
    """Return a dictionary: `gravity` along the gap (m/s^2), `friction` (N) of the loose `mass`.

    `inclination` (radian, or text such as "90 deg") is the angle of the gap to the horizontal, by
    default 0. Gravity along the gap follows from this angle, unless `gravity` is given. The
    friction is `friction_coefficient` times `normal_force` (N), with which the loose mass presses
    its floor. By default `normal_force` is the weight times the cosine of `inclination`. `friction`
    may be given in place of `friction_coefficient` and `normal_force`.
    """
    mass = check_si("mass", mass, "mass", above=0)
    coefficient = check_si("friction_coefficient", friction_coefficient, "number", **FRICTIONS)
    if inclination is not None and gravity is not None:
        raise ValueError("gravity: must be left out with inclination, from which it follows")
    if friction is not None and (coefficient or normal_force is not None):
        raise ValueError(
            "friction: must be left out with friction_coefficient and normal_force, from which it "
            "follows"
        )
    angle = 0.0 if inclination is None else check_si("inclination", inclination, "angle", **ANGLES)
    along = GRAVITY * math.sin(angle)
    if gravity is not None:
        along = check_si("gravity", gravity, "acceleration", **GRAVITIES)
    if friction is None:
        normal = mass * GRAVITY * math.cos(angle) if angle < VERTICAL else 0.0
        if normal_force is not None:
            normal = check_si("normal_force", normal_force, "force", least=0, most=1e9)
        elif coefficient and not normal:
            raise ValueError(
                "normal_force: must be given with friction_coefficient if the gap is vertical, "
                "because no weight presses the loose mass on its floor"
            )
        friction = coefficient * normal
    return {"gravity": along, "friction": friction}


@bounds.names_arguments
@dataclass(frozen=True, kw_only=True)
class TunedAbsorber:
    """A mass that is connected to a machine by a spring and a dashpot.

    Each value is a number in the SI unit, text with units, or a quantity of pint.

    Examples
    --------
    >>> TunedAbsorber(mass="0.6 kg", stiffness="9e3 N/m", damping=20).stiffness
    9000.0
    """

    mass: float = physical("mass", "mass of a tuned absorber", above=0)
    stiffness: float = physical("stiffness", "stiffness of its spring", above=0)
    damping: float = physical("damping", "coefficient of its dashpot", least=0)

    def __post_init__(self):
        convert(self)

    def detuned(self, detuning) -> "TunedAbsorber":
        """Return a copy of the absorber whose stiffness is multiplied by 1 + detuning."""
        factor = 1 + bounds.check_number("detuning", detuning, above=-1, most=10)
        return replace(self, stiffness=self.stiffness * factor)


def static_deflection(force, linear, cubic) -> float:
    """Return the deflection x > 0 at which linear x + |cubic| x^3 equals a force, in SI units."""
    cubic = abs(cubic)
    if cubic == 0:
        return force / linear
    if linear == 0:
        return (force / cubic) ** (1 / 3)
    length = math.sqrt(linear) / math.sqrt(3 * cubic)
    return 2 * length * math.sinh(math.asinh(1.5 * force / (linear * length)) / 3)


def describe_si(machine, damper=None) -> dict:
    """Return a dictionary of the values of a machine and its damper in SI units."""
    others = ("natural_frequency", "quality_factor")  # computed from stiffness and damping ratio
    found = {
        name: float(value)
        for name, value in asdict(machine).items()
        if value is not None and name not in others
    }
    if damper is not None:
        values = asdict(damper)
        found |= {"damper_mass": values.pop("mass")} | values
    return found
