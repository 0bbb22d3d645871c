"""An impact damper in SI units."""

from dataclasses import dataclass

from impact_damper.model.bounds import (
    CLEARANCE_RANGE,
    MASS_RATIO_RANGE,
    RESTITUTION_RANGE,
    STIFFNESS_RANGE,
    shown,
)
from impact_damper.model.hertz import HertzContact
from impact_damper.model.names import names_arguments
from impact_damper.model.parameters import Damper
from impact_damper.model.text import with_unit
from impact_damper.model.units import check_si, convert, physical


@names_arguments
@dataclass(frozen=True, kw_only=True)
class MachineDamper:
    """A loose mass in a gap of a machine, in SI units; made and checked by `Machine.damper`.

    Each value is a number in the SI unit, text with units, or a quantity of pint. The contact is
    given as `contact_stiffness` or as `contact`.

    Attributes
    ----------
    mass : float
        kg.
    gap : float
        Full play of the loose mass from wall to wall, m.
    restitution : float
        Coefficient of restitution, 1 for elastic contact.
    contact_stiffness : float or None
        Stiffness of the contact, N/m.
    contact : HertzContact or None
        Contact after Hertz. It is replaced by a linear spring whose stiffness depends on the speed
        of impact; `hertz_stiffness` finds this stiffness for a motion.

    Raises
    ------
    TypeError, ValueError
        If a value is missing or out of range, or both contact arguments are given.
    """

    mass: float = physical("mass", above=0)
    gap: float = physical("clearance", above=0)
    restitution: float = physical("number", **RESTITUTION_RANGE, default=1.0)
    contact_stiffness: float | None = physical("stiffness", above=0, default=None)
    contact: HertzContact | None = None

    def __post_init__(self):
        convert(self)
        if (self.contact_stiffness is None) == (self.contact is None):
            raise ValueError(
                "contact_stiffness: must be given, or contact in its place, and not both"
            )
        if self.contact is not None and not isinstance(self.contact, HertzContact):
            raise TypeError(f"contact = {shown(self.contact)}: must be a HertzContact")

    @property
    def clearance_each_side(self) -> float:
        """Half of the gap, between the centred loose mass and either wall, m."""
        return self.gap / 2

    def check_for(self, machine):
        """Raise ValueError, with the range allowed, if the damper does not fit a machine.

        The gap must be larger than the static play. If the static force of the machine accelerates
        both masses together, a contact passes the fraction m2/(m1 + m2) of this force on to the
        loose mass m2. The static play is the compression of both contacts under this fraction.
        """
        scales = machine.scales
        clearances = scales.range_to_si(CLEARANCE_RANGE, "clearance")
        gaps = {end: 2 * value for end, value in clearances.items()}
        check_si("mass", self.mass, "mass", **scales.range_to_si(MASS_RATIO_RANGE, "mass"))
        check_si("gap", self.gap, "clearance", **gaps)
        if self.contact_stiffness is not None:
            bounds = scales.range_to_si(STIFFNESS_RANGE, "stiffness")
            check_si("contact_stiffness", self.contact_stiffness, "stiffness", **bounds)
            share = self.mass / (machine.mass + self.mass)
            play = 2 * share * machine.static_force / self.contact_stiffness
            why = "static play: compression of the contacts on both sides"
            check_si("gap", self.gap, "clearance", above=play, why=why)

    def scaled(self, scales) -> Damper:
        """Return the dimensionless damper, in the scales of its machine.

        Raises
        ------
        ValueError
            If the contact has no stiffness yet.
        """
        if self.contact_stiffness is None:
            raise ValueError(
                f"contact = {shown(self.contact)}: must be a contact_stiffness here, as "
                "hertz_stiffness finds it for a motion"
            )
        return Damper(
            mass_ratio=scales.from_si(self.mass, "mass"),
            clearance=scales.from_si(self.clearance_each_side, "clearance"),
            restitution=self.restitution,
            contact_stiffness=scales.from_si(self.contact_stiffness, "stiffness"),
        )

    def __str__(self):
        parts = [
            f"mass {with_unit(self.mass, 'kg')}",
            f"gap {with_unit(1e3 * self.gap, 'mm')} (full play)",
            f"restitution {self.restitution:g}",
        ]
        if self.contact_stiffness is not None:
            parts.append(f"contact stiffness {with_unit(self.contact_stiffness, 'N/m')}")
        return ", ".join(parts)
