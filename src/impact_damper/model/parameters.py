"""Dataclasses of the oscillator and of the damper, dimensionless as in section 2.1 of the paper.

Lengths are divided by x0 = (F0/k1)^(1/3), and times by 1/w0 = sqrt(m1/(k1 x0^2)). F0 is the
amplitude of the force, k1 the coefficient of the cubic spring, and m1 the primary mass.
"""

import math
from dataclasses import dataclass, field, fields

from impact_damper.model import bounds
from impact_damper.model.exit_rules import EXIT_RULES, ZERO_PENETRATION, damping_ratio
from impact_damper.model.units import UNITLESS, Scales


def parameter(limits, kind, symbol, meaning, *, machine=None, power=None, **default):
    """Return a dataclass field for a dimensionless parameter. The field's metadata describe it.

    `limits` are the bounds of the value. `kind` is a key of `units.QUANTITIES`. `machine` is given
    if the parameter has another name in `Machine` or `MachineDamper`, and is that name. `power` is
    given for a coefficient of the spring, and is the exponent of Z1 in its term.
    """
    facts = {"bounds": limits, "kind": kind, "symbol": symbol, "machine": machine, "power": power}
    return field(metadata=facts | {"meaning": f"{symbol}, {meaning}"}, **default)


def _check(part):
    for each in parameters_in(part):
        value = getattr(part, each.name)
        number = bounds.check_number(each.name, value, **each.metadata["bounds"])
        if hasattr(value, "ndim"):
            object.__setattr__(part, each.name, number)


def check_damper(damper):
    """Raise TypeError if `damper` is not a Damper; None is an error too."""
    if not isinstance(damper, Damper):
        raise TypeError(f"damper = {bounds.shown(damper)}: must be a Damper")


@bounds.names_arguments
@dataclass(frozen=True)
class Oscillator:
    """Harmonically forced Duffing oscillator, equation (3) without the damper, dimensionless.

    The forcing has the amplitude F + U W^2. U stands for a rotating unbalance, or for a base whose
    displacement has a fixed amplitude. On a moving base Z1 is relative to the base, and the forcing
    is the force of inertia. This force acts on the loose mass too, so `base` is 1.

    Raises
    ------
    TypeError, ValueError
        If a value is no number, or is out of range.

    Examples
    --------
    >>> oscillator = Oscillator(damping=0.215)
    >>> oscillator.linear_frequency, oscillator.cubic
    (0.0, 1.0)
    """

    damping: float = parameter(bounds.DAMPING_RANGE, "damping", "h", "damping")
    linear_frequency: float = parameter(
        {"least": 0.0, "most": 100.0},
        "frequency",
        "omega_l",
        "0 for a purely cubic spring",
        machine="natural_frequency",
        default=0.0,
    )
    cubic: float = parameter(
        {"least": -1e6, "most": 1e6},
        "cubic_stiffness",
        "k3",
        "coefficient of the cubic spring",
        machine="cubic_stiffness",
        power=3,
        default=1.0,
    )
    force: float = parameter(
        bounds.AMPLITUDE_RANGE, "force", "F", "amplitude of the external force", default=1.0
    )
    unbalance: float = parameter(
        bounds.AMPLITUDE_RANGE,
        "unbalance",
        "U",
        "adds U W^2 to the amplitude of the force",
        default=0.0,
    )
    base: float = parameter(
        {"least": 0.0, "most": 1.0},
        "number",
        "B",
        "share of the force, per unit of mass, that accelerates the loose mass too",
        default=0.0,
    )
    scales: Scales = field(default=UNITLESS, repr=False, compare=False, kw_only=True)

    def __post_init__(self):
        _check(self)

    @property
    def _terms(self) -> list:
        return [name for name in NONLINEAR if getattr(self, name)]

    def told(self, *names) -> str:
        """Return parameters as text, such as "cubic = 1". For a machine they have SI units."""
        found = []
        for name in names:
            facts = self.__dataclass_fields__[name].metadata
            shown_name = facts["machine"] or name if self.scales.si else name
            found.append(self.scales.told(shown_name, getattr(self, name), facts["kind"]))
        return ", ".join(found)

    @property
    def softens(self) -> bool:
        """Whether the spring pushes outward at large |Z1|, so that a motion may escape."""
        highest = max(self._terms, key=NONLINEAR.get, default="cubic")
        return getattr(self, highest) < 0

    @property
    def hardening(self) -> float:
        """Factor (3/4) k3. If Z1 = a cos(W T), the first harmonic of k3 Z1^3 is (3/4) k3 a^2 Z1."""
        others = [name for name in self._terms if name != "cubic"]
        if others:
            raise ValueError(f"{self.told(*others)}: must be 0 in closed forms (cubic springs)")
        return 0.75 * self.cubic

    def forcing_amplitude(self, frequency):
        """Return the amplitude F + U W^2 of the force at forcing frequencies W."""
        return self.force + self.unbalance * frequency**2


@bounds.names_arguments
@dataclass(frozen=True)
class Damper:
    """Loose mass in a gap whose walls have a spring and a dashpot (figures 1 and 9 of the paper).

    `exit_rule` decides when a contact ends (see `exit_rules`). With "zero_penetration", the rule of
    the paper, the walls may pull. With "no_tension" the walls never pull.

    Raises
    ------
    TypeError, ValueError
        If a value is no number, or is out of range.

    Examples
    --------
    >>> Damper(mass_ratio=0.12, clearance=2.0).exit_rule
    'zero_penetration'
    """

    mass_ratio: float = parameter(
        bounds.MASS_RATIO_RANGE, "mass", "rm", "loose mass over primary mass", machine="mass"
    )
    clearance: float = parameter(
        bounds.CLEARANCE_RANGE, "gap", "d0", "half of the gap of the loose mass", machine="gap"
    )
    restitution: float = parameter(
        bounds.RESTITUTION_RANGE, "number", "e", "1 for elastic contact", default=1.0
    )
    contact_stiffness: float = parameter(
        bounds.STIFFNESS_RANGE,
        "stiffness",
        "r1",
        "stiffness of the contact springs",
        default=2000.0,
    )
    gravity: float = parameter(
        {"least": -1e6, "most": 1e6},
        "acceleration",
        "G",
        "component of gravity along the gap, towards the wall at Z2 = d0",
        default=0.0,
    )
    friction: float = parameter(
        bounds.AMPLITUDE_RANGE,
        "acceleration",
        "f",
        "Coulomb friction of the loose mass on its floor, per unit of its mass",
        default=0.0,
    )
    exit_rule: str = ZERO_PENETRATION

    def __post_init__(self):
        _check(self)
        if self.exit_rule not in EXIT_RULES:
            allowed = ", ".join(EXIT_RULES)
            given = bounds.shown(self.exit_rule)
            raise ValueError(f"exit_rule = {given}: must be one of {allowed}")

    @property
    def contact_damping(self) -> float:
        """Damping ratio zeta_c of a contact, as in the paper, if the primary mass were held fixed.

        It is z/sqrt(1 + rm). z is the damping ratio of a contact in which both masses move.
        Equation (25) gives z for the paper's exit rule. `exit_rules` gives z for "no_tension".
        """
        return damping_ratio(self.restitution, self.exit_rule) / math.sqrt(1 + self.mass_ratio)

    @property
    def contact_frequency(self) -> float:
        """Natural frequency wn = sqrt(r1 (1 + 1/rm)) of a contact. Elastic contacts last pi/wn."""
        return math.sqrt(self.contact_stiffness * (1 + 1 / self.mass_ratio))

    @property
    def dashpot(self) -> float:
        """Coefficient 2 `contact_damping` sqrt(r1 rm) of a wall's dashpot (equation (22))."""
        return 2 * self.contact_damping * math.sqrt(self.contact_stiffness * self.mass_ratio)


def beyond_closed_forms(oscillator, damper) -> list:
    """Return which of the parameters gravity, friction and base are not 0.

    The list has a pair for each parameter that is not 0. The first entry of the pair is the object
    that has the parameter, `damper` or `oscillator`. The second entry is the parameter's name.
    """
    terms = (damper, "gravity"), (damper, "friction"), (oscillator, "base")
    return [(part, name) for part, name in terms if getattr(part, name)]


def check_closed_form(oscillator, damper):
    """Raise an error if gravity, friction or base is not 0, or if `damper` is no Damper."""
    check_damper(damper)
    why = "must be 0 in closed forms and harmonic balance with a damper; simulate it instead"
    for part, name in beyond_closed_forms(oscillator, damper):
        kind = part.__dataclass_fields__[name].metadata["kind"]
        raise ValueError(f"{oscillator.scales.told(name, getattr(part, name), kind)}: {why}")


def parameters_in(part) -> list:
    """Return the float and int fields of `part`, a dataclass or an instance of a dataclass."""
    return [each for each in fields(part) if each.type in (int, float)]


# Each nonlinear term of the spring: name of its coefficient ("cubic"), and its exponent of Z1 (3).
NONLINEAR = {
    each.name: each.metadata["power"]
    for each in parameters_in(Oscillator)
    if each.metadata["power"]
}
SPRING_POWER = max(NONLINEAR.values())
# Symbols of parameters, for tables and captions. The keys are the names of the parameters.
SYMBOLS = {
    each.name: each.metadata["symbol"]
    for part in (Oscillator, Damper)
    for each in parameters_in(part)
} | {"frequency": "W"}


def describe(*parts) -> dict:
    """Return the parameters of several dataclasses in one dictionary. A part may be None."""
    return {
        each.name: getattr(part, each.name)
        for part in parts
        if part is not None
        for each in parameters_in(part)
    }


def pick(kind, values) -> dict:
    """Return the entries of `values` whose keys are parameters of the dataclass `kind`."""
    return {each.name: values[each.name] for each in parameters_in(kind) if each.name in values}
