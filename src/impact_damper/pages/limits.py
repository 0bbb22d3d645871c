"""Sections of a page: what was not looked at, and how the numbers were found."""

from impact_damper.data.datasets import parameters_of
from impact_damper.pages.blocks import Numbers, Points, Section, Words, shown

NOT_LOOKED_AT = [
    "Frequencies between those of the grid: {count} from {low} to {high}, resonances among them.",
    "Starts beyond three times the motions of the machine without the damper.",
    "Friction and gravity on the loose mass, and air in the gap.",
    "Wear, which widens the gap and changes the restitution.",
    "A restitution that changes with the speed of impact by more than its tolerance.",
    "Motion in other directions, and turning of the loose mass.",
    "Other modes of the machine, which hard impacts may excite.",
    "Manufacture of the absorbers that are compared: only their springs are detuned.",
]
SOURCES = (
    "Every number above names its source, a variable of the file {name}.nc; names with a dot are "
    "values in its attributes machine and parameters."
)


def missing(data) -> Section:
    """Return the section on what was not looked at."""
    asked = parameters_of(data)
    low, high = (shown(end, "Hz", 4) for end in asked["band"])
    texts = list(NOT_LOOKED_AT)
    texts[0] = texts[0].format(count=data.sizes["frequency"], low=low, high=high)
    if not asked["tolerances"]:
        texts.append("Tolerances: none were given.")
    lost = int(data["force_edges_lost"]) + int(data["damper_edges_lost"])
    if lost:
        texts.append(f"Edges of the quiet orbit in the maps: {lost} were not found.")
    return Section("What was not looked at", [Points(texts)])


def origin(name, data) -> Section:
    """Return the section on how the numbers were found."""
    asked = parameters_of(data)
    rows = [
        ("motions run in the first look", f"{int(data['screen_motions'])}", "screen_motions"),
        ("exact orbits of the first look", f"{int(data['screen_orbits'])}", "screen_orbits"),
        (
            "motions run to compare gaps",
            f"{int(data['compared_motions'])}",
            "compared_motions",
        ),
        ("seed of all random draws", f"{asked['seed']}", "parameters.seed"),
    ]
    words = Words(SOURCES.format(name=name))
    return Section("Where the numbers come from", [words, Numbers(rows)])
