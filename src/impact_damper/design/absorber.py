"""A tuned absorber in SI units."""

from dataclasses import dataclass, replace

from impact_damper.model.bounds import MASS_RATIO_RANGE, check_number, shown
from impact_damper.model.machine import Machine
from impact_damper.model.names import names_arguments
from impact_damper.model.text import with_unit
from impact_damper.model.units import check_si, convert, physical


@names_arguments
@dataclass(frozen=True, kw_only=True)
class TunedAbsorber:
    """A mass that is connected to a machine by a spring and a dashpot; all values in SI units.

    Each value is a number in the SI unit, text with units, or a quantity of pint. Let u be the
    displacement of the machine relative to the absorber. Spring and dashpot act on the machine with
    the force stiffness u + cubic_stiffness u^3 + damping u', against u.

    Attributes
    ----------
    mass : float
        kg.
    stiffness, cubic_stiffness : float
        N/m and N/m^3.
    damping : float
        N s/m.

    Raises
    ------
    TypeError, ValueError
        If a value is out of range.

    Examples
    --------
    >>> TunedAbsorber(mass="0.6 kg", stiffness="9e3 N/m", damping=20).stiffness
    9000.0
    """

    mass: float = physical("mass", above=0)
    stiffness: float = physical("stiffness", least=0)
    damping: float = physical("damping", least=0)
    cubic_stiffness: float = physical("cubic_stiffness", default=0.0)

    def __post_init__(self):
        convert(self)
        if self.stiffness == 0 and self.cubic_stiffness <= 0:
            raise ValueError(
                f"stiffness = {with_unit(0.0, 'N/m')}: must be greater than 0 N/m with "
                f"cubic_stiffness = {with_unit(self.cubic_stiffness, 'N/m^3')} (without a force "
                "that restores it the absorber drifts away)"
            )

    def detuned(self, detuning) -> "TunedAbsorber":
        """Return the absorber with both stiffnesses times 1 + detuning."""
        factor = 1 + check_number("detuning", detuning, above=-1, most=10)
        return replace(
            self,
            stiffness=self.stiffness * factor,
            cubic_stiffness=self.cubic_stiffness * factor,
        )


def check_mass(machine, mass) -> float:
    """Return the mass of an absorber in kg.

    Raises
    ------
    TypeError, ValueError
        If `machine` is not a `Machine`, or the mass is too small or too large for this machine.
    """
    if not isinstance(machine, Machine):
        raise TypeError(f"machine = {shown(machine)}: must be a Machine")
    least = MASS_RATIO_RANGE["least"] * machine.mass
    return check_si(
        "mass", mass, "mass", least=least, most=machine.mass, why="the mass of the machine"
    )
