"""Scaled drawing of a machine with its damper, with the dimensions to build."""

import json

from impact_damper.data.datasets import parameters_of
from impact_damper.figures.schematic_parts import (
    arrow,
    dashpot,
    ground,
    letter,
    mass,
    sheet,
    spring,
    stroke,
    wheels,
)
from impact_damper.figures.style import GREY, PALE_SKY, VERMILION, WHITE, style

CAPTION = """
The machine and its damper, to scale if both masses are cubes of steel (7850 kg/m^3). The gap is
drawn whole on one side: it is the full play of the loose mass, from wall to wall.
"""
STEEL = 7850.0
WIDTH, HEIGHT, RAIL = 2.0, 1.7, 0.3  # inches


@style()
def draw_drawing(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    made = json.loads(data.attrs["machine"])
    gap = float(data["design_gap"])
    body, loose = (1e3 * (made[name] / STEEL) ** (1 / 3) for name in ("mass", "damper_mass"))
    length = max(body, 1.2 * (loose + gap))
    scale = WIDTH / length  # inches per millimetre
    axes = sheet("single", 2.9)
    left, bottom, height = 1.05, RAIL + 0.16, body * scale
    return axes.figure
