"""Transients of a machine with and without damper: swept sine and unforced decay."""

from impact_damper.data.variables.variable import Variable

ENDS = {"completed": 0, "escaped": 1, "at_rest": 2, "limit": 3}
VARIABLES = {
    "direction": Variable(("direction",), "direction in which the forcing frequency is swept"),
    "equipment": Variable(("equipment",), "whether the machine has its damper"),
    "envelope": Variable(
        ("equipment", "window"),
        "largest displacement in a cycle or, without forcing, in a period of the unforced "
        "vibration",
        quantity="displacement",
    ),
    "window_contacts": Variable(
        ("equipment", "window"),
        "contacts begun in a cycle or, without forcing, in a period of the unforced vibration",
    ),
    "transient_status": Variable(("equipment",), "how the transient ended", flags=ENDS),
}
