"""Contact stiffness of a damper before its design, from radius and materials."""

from impact_damper.design.task import Task
from impact_damper.model.hertz import HertzContact
from impact_damper.model.machine import Machine

# Dimensionless contact stiffness that completes a task here. Any allowed value would do.
TYPICAL = 2000.0


def contact_stiffness_of(machine, mass, band, stiffness, contact):
    """Return the contact stiffness given or, without one, the stiffness of a contact after Hertz.

    The stiffness after Hertz grows with the speed of impact. The speed used here is that of a loose
    mass that crosses the gap by rule (18) of the paper (`Task.rule_gap`) in half a cycle, at the
    middle frequency of the band.

    Parameters
    ----------
    machine : Machine
    mass, band
        As in `design.task.Task`.
    stiffness : float, str, pint.Quantity or None
        N/m.
    contact : HertzContact or None

    Returns
    -------
    float, str or pint.Quantity
        N/m; `stiffness` unchanged if it is given.

    Raises
    ------
    TypeError, ValueError
        If both are missing, `contact` is something else, or machine, mass or band are out of range.
    """
    if contact is not None and not isinstance(contact, HertzContact):
        raise TypeError(f"contact = {contact!r}: must be a HertzContact")
    if stiffness is None and contact is None:
        raise ValueError("contact_stiffness: must be given, or contact in its place")
    if stiffness is not None:
        return stiffness
    # A task needs a restitution and a stiffness, which have no effect on the gap of the rule.
    known = isinstance(machine, Machine)
    typical = machine.scales.to_si(TYPICAL, "stiffness") if known else TYPICAL
    asked = {"machine": machine, "mass": mass, "band": band}
    task = Task(**asked, restitution=1.0, contact_stiffness=typical)
    middle = sum(task.band) / 2
    reduced = machine.mass * task.mass / (machine.mass + task.mass)
    return contact.stiffness(2 * task.rule_gap(middle) * middle, reduced)
