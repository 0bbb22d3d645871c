"""Costs of a motion with a damper: impacts, forces, losses and noise."""

from impact_damper.data.variables.variable import Variable

VARIABLES = {
    "costs_status": Variable(
        (),
        "whether the motion has impacts, has none, or escapes over a barrier of the spring",
        flags={"impacts": 0, "no_impact": 1, "escaped": 2},
    ),
    "costs_time": Variable((), "time over which the motion is measured", quantity="time"),
    # impacts
    "contact_impulse": Variable(
        ("contact",), "impulse of the force of a contact", quantity="impulse"
    ),
    "contact_loss": Variable(("contact",), "energy lost in a contact", quantity="energy"),
    "impact_rate": Variable((), "impacts per time", quantity="rate"),
    "mean_impact_speed": Variable(
        (), "mean relative speed at the beginning of a contact", quantity="velocity"
    ),
    "mean_impact_loss": Variable((), "mean energy lost in an impact", quantity="energy"),
    "contact_force": Variable((), "largest force in a contact", quantity="force"),
    "penetration": Variable((), "largest penetration of a wall", quantity="displacement"),
    "largest_acceleration": Variable(
        (), "largest acceleration of the primary mass", quantity="acceleration"
    ),
    "impulse_noise": Variable(
        (), "sum of the squared impulses, per time", quantity="impulse_noise"
    ),
    # powers
    "force_power": Variable((), "mean power of the external force", quantity="power"),
    "dashpot_power": Variable(
        (), "mean power lost in the dashpot of the primary mass", quantity="power"
    ),
    "impact_power": Variable((), "mean power lost in contacts", quantity="power"),
    "stored_power": Variable((), "growth of the energy of the motion per time", quantity="power"),
    "power_error": Variable(
        (), "power of the force minus all losses and the growth of energy, divided by the losses"
    ),
    # contact of curved bodies after Hertz
    "hertz_force": Variable(
        (), "force after Hertz of an impact at the largest speed", quantity="force"
    ),
    "contact_pressure": Variable(
        (), "largest pressure after Hertz of an impact at the largest speed", quantity="pressure"
    ),
    "contact_yields": Variable(
        (),
        "whether the material yields at this pressure",
        flags={"no": 0, "yes": 1, "unknown": 2},
    ),
}
