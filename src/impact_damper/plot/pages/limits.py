"""Sections of a page: what was not considered, and how the numbers were found."""

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.pages.blocks import Numbers, Points, Section, Words, shown

NOT_LOOKED_AT = [
    "Frequencies other than the {count} of the grid from {low} to {high}. The grid includes the "
    "resonances.",
    "Starts larger than three times the motions of the machine without the damper.",
    "Friction and gravity on the loose mass, and air in the gap.",
    "Wear, which widens the gap and changes the restitution.",
    "A restitution that changes with the speed of impact by more than its tolerance.",
    "Motion in other directions, and turning of the loose mass.",
    "Other modes of the machine, which hard impacts may excite.",
    "Deviations of the absorbers from their design, except of the stiffness of their springs.",
]
SOURCES = (
    "Each number above names its source, a variable of the file {file}. A name with a dot is a "
    "value in the attribute `machine` or `parameters` of this file."
)


def missing(data) -> Section:
    """Return the section on what was not considered."""
    asked = parameters_of(data)
    low, high = (shown(end, "Hz", 4) for end in asked["band"])
    texts = list(NOT_LOOKED_AT)
    texts[0] = texts[0].format(count=data.sizes["frequency"], low=low, high=high)
    if not asked["tolerances"]:
        texts.append("Tolerances: none were given.")
    return Section("What was not considered", [Points(texts)])


def origin(file, data) -> Section:
    """Return the section on how the numbers were found, for a dataset in the file named `file`."""
    asked = parameters_of(data)
    rows = [
        ("motions run in the screening", f"{int(data['screen_motions'])}", "screen_motions"),
        ("exact orbits of the screening", f"{int(data['screen_orbits'])}", "screen_orbits"),
        (
            "motions run to compare gaps",
            f"{int(data['compared_motions'])}",
            "compared_motions",
        ),
        ("seed of all random numbers", f"{asked['seed']}", "parameters.seed"),
    ]
    words = Words(SOURCES.format(file=file))
    return Section("Where the numbers come from", [words, Numbers(rows)])
