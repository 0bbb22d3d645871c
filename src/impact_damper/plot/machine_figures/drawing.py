"""Scaled drawing of a machine with its damper, and the gap to build."""

import json

from matplotlib.patches import Circle

from impact_damper.plot.schematic_parts import (
    arrow,
    dashpot,
    filled,
    ground,
    letter,
    mass,
    sheet,
    spring,
    stroke,
    wheels,
)
from impact_damper.plot.style import BLACK, GREY, PALE_SKY, VERMILION, WHITE, style

STEEL = 7850.0  # density, kg/m^3
# Layout in inches: x of the wall, x of the left side of the machine, largest width and height of
# the machine, y of the rail.
WALL, LEFT, WIDTH, HEIGHT, RAIL = 0.28, 0.95, 1.75, 1.75, 0.42
SMALL = {"size": 8.0}


@style()
def draw_drawing(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    made, gap = json.loads(data.attrs["machine"]), float(data["design_gap"])
    body, loose = (1e3 * (made[name] / STEEL) ** (1 / 3) for name in ("mass", "damper_mass"))
    length = max(body, 1.25 * (loose + gap))
    scale = min(WIDTH / length, HEIGHT / body)  # inches per millimetre
    axes = sheet("single", 3.0)
    bottom, width, height = RAIL + 0.16, length * scale, body * scale
    _carriage(axes, bottom, width, height, made)
    left = LEFT + (width - (loose + gap) * scale) / 2
    _slot(axes, left, bottom + 0.3 * height, loose * scale, gap * scale)
    letter(axes, LEFT + width / 2, bottom + height + 0.17, f"gap {gap:.3g} mm", color=VERMILION)
    letter(axes, left + loose * scale / 2, bottom + 0.3 * height + 0.48 * loose * scale, "$m_2$")
    letter(axes, LEFT + width / 2, bottom + 0.12, f"$m_1$ = {made['mass']:.4g} kg", **SMALL)
    words = f"$m_2$ = {made['damper_mass']:.4g} kg, $e$ = {made['restitution']:.3g}"
    letter(axes, LEFT + width / 2, 2.85, words, **SMALL)
    _scale_bar(axes, scale, body)
    return axes.figure


def _carriage(axes, bottom, width, height, made):
    """Draw the machine on its rail between a wall on the left and its excitation."""
    ground(axes, (WALL, 2.45), (WALL, RAIL))
    ground(axes, (WALL, RAIL), (3.3, RAIL))
    mass(axes, LEFT, bottom, width, height)
    wheels(axes, (LEFT + 0.2 * width, LEFT + 0.8 * width), RAIL)
    spring(axes, WALL, LEFT, bottom + 0.72 * height)
    dashpot(axes, WALL, LEFT, bottom + 0.3 * height)
    between = (WALL + LEFT) / 2
    stiffness = "$k, k_3$" if made.get("cubic_stiffness") else "$k$"
    letter(axes, between, bottom + 0.72 * height + 0.2, stiffness, **SMALL)
    letter(axes, between, bottom + 0.3 * height + 0.2, "$c$", **SMALL)
    right = LEFT + width
    look = {"color": VERMILION}
    if "unbalance" in made:
        centre = (right - 0.25, bottom + 0.25)
        axes.add_patch(Circle(centre, 0.17, **filled(WHITE)))
        axes.add_patch(Circle((centre[0] + 0.09, centre[1] + 0.06), 0.045, **look))
        letter(axes, centre[0] + 0.02, centre[1] + 0.28, "$u$", **look)
    elif "force" in made:
        arrow(axes, (right, bottom + height / 2), (right + 0.42, bottom + height / 2), **look)
        letter(axes, right + 0.25, bottom + height / 2 + 0.16, "$F$", **look)
    else:
        arrow(axes, (WALL, 2.62), (WALL + 0.45, 2.62), head="<|-|>", **look)
        letter(axes, WALL + 0.22, 2.78, "$A$", **look)


def _slot(axes, left, bottom, loose, gap):
    """Draw the slot, the loose mass at the left wall of the slot, and the gap beside the mass."""
    mass(axes, left, bottom, loose + gap, 1.1 * loose, WHITE)
    mass(axes, left, bottom, loose, loose, PALE_SKY)
    walls, y = (left + loose, left + loose + gap), bottom + 1.1 * loose + 0.18
    for x in walls:
        stroke(axes, [(x, bottom + loose), (x, y + 0.06)], "fine", color=GREY)
    if gap > 0.25:
        arrow(axes, (walls[0], y), (walls[1], y), "fine", "<|-|>", VERMILION)
    else:
        arrow(axes, (walls[0] - 0.22, y), (walls[0], y), "fine", color=VERMILION)
        arrow(axes, (walls[1] + 0.22, y), (walls[1], y), "fine", color=VERMILION)


def _scale_bar(axes, scale, body):
    """Draw a bar below the rail: the longest round length shorter than the machine (`body`, mm)."""
    length = max(each for each in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if each < body)
    end, y = 3.2, 0.16
    stroke(axes, [(end - length * scale, y), (end, y)], color=BLACK)
    letter(axes, end - length * scale - 0.08, y, f"{length} mm", ha="right", **SMALL)
