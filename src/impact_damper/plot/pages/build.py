"""Section of a page: what to build."""

import json

import numpy as np

from impact_damper.data.datasets import named, parameters_of
from impact_damper.data.sweeps import quiet_gaps
from impact_damper.model.machine import EXCITATIONS
from impact_damper.plot.machine_figures import drawing
from impact_damper.plot.pages.blocks import Numbers, Picture, Section, Words, percent, shown

# Field of `Machine` -> description, unit shown, and size of this unit in SI units.
GIVEN = {
    "mass": ("mass without the loose mass", "kg", 1),
    "linear_stiffness": ("stiffness of the spring", "N/m", 1),
    "cubic_stiffness": ("cubic stiffness of the spring", "N/m³", 1),
    "damping_ratio": ("damping ratio", "%", 0.01),
    "damping": ("coefficient of the dashpot", "N s/m", 1),
    "force": ("amplitude of the force", "N", 1),
    "unbalance": ("unbalance", "kg mm", 1e-3),
    "base_displacement": ("amplitude of the moving base", "mm", 1e-3),
    "base_acceleration": ("amplitude of the base's acceleration", "m/s²", 1),
}
HOW = (
    "Give the loose mass a straight slot in the machine, along the direction in which the machine "
    "moves, with a hard wall at each end. The gap is the whole free path of the loose mass from "
    "wall to wall, which is the length of the slot minus the length of the loose mass. The loose "
    "mass must slide or roll freely. A wall has the right restitution if the loose mass, dropped "
    "on it from a height of 1 m, rebounds to {height:.2g} m."
)
WRONG = (
    "The values below belong to the least bad damper found. They are shown so that the "
    "decision can be checked, not to be built."
)


def section(data) -> Section:
    """Return the section for the dataset of `stages.machines.design_damper`."""
    made, asked = json.loads(data.attrs["machine"]), parameters_of(data)
    height = made["restitution"] ** 2
    blocks = [Words(HOW.format(height=height))]
    title = "What to build"
    if named(data, "design_choice") == "least_worst":
        title, blocks = "What was found instead of a damper to build", [Words(WRONG)]
    blocks.append(Picture("drawing", drawing.CAPTION))
    blocks.append(Numbers([*_damper(data, made, asked), *_machine(asked)]))
    return Section(title, blocks)


def _damper(data, made, asked):
    """Return the rows of the damper."""
    gap, ratio = float(data["design_gap"]), made["damper_mass"] / made["mass"]
    force = float(data["contact_force_by_frequency"].max())
    # If the gap must be held more closely than its tolerance, the next row shows the range instead.
    deviation = _deviation(asked, "gap") if named(data, "design_choice") == "robust" else ""
    stiffness = made["contact_stiffness"]
    return [
        ("gap, the full play", f"{shown(gap, 'mm')}{deviation}", "design_gap"),
        ("gap, allowed range", *_allowed(data, gap, asked)),
        (
            "loose mass",
            f"{shown(made['damper_mass'], 'kg')}, {percent(ratio)} of the machine",
            "machine.damper_mass",
        ),
        (
            "restitution of the walls",
            f"{shown(made['restitution'])}{_deviation(asked, 'restitution')}",
            "machine.restitution",
        ),
        (
            "stiffness of the walls",
            f"{shown(stiffness, 'N/m')}{_deviation(asked, 'contact_stiffness')}",
            "machine.contact_stiffness",
        ),
        (
            "largest force that a wall must bear",
            f"{shown(force, 'N')}, with a penetration of {shown(1e3 * force / stiffness, 'mm')}",
            "contact_force_by_frequency, machine.contact_stiffness",
        ),
    ]


def _allowed(data, gap, asked):
    """Return the range of gaps for which the promise holds, as text, and its source."""
    tolerance = asked["tolerances"].get("gap", 0.0)
    kind = named(data, "design_choice")
    if kind == "robust":
        ends = gap * (1 + tolerance * np.array([-1, 1]))
        words = f"{shown(ends[0], 'mm', 4)} to {shown(ends[1], 'mm', 4)}"
        return words, "parameters.tolerances.gap"
    if kind == "needs_tolerance":
        return f"{quiet_gaps(data)} mm", "cliff_gap, cliff_status"
    return "none", "design_choice"


def _machine(asked):
    """Return the rows of the given values: machine and band."""
    machine = asked["machine"]
    deviating = {"damping_ratio": "damping", "linear_stiffness": "stiffness"}
    deviating |= {"damping": "damping", "cubic_stiffness": "stiffness"}
    deviating |= {name: "force" for name in EXCITATIONS}
    rows = [
        (
            f"machine: {words}",
            f"{shown(machine[name] / size, unit)}{_deviation(asked, deviating.get(name, name))}",
            f"parameters.machine.{name}",
        )
        for name, (words, unit, size) in GIVEN.items()
        if machine.get(name)
    ]
    low, high = asked["band"]
    band = f"{shown(low, 'Hz', 4)} to {shown(high, 'Hz', 4)}"
    return [*rows, ("band of forcing frequencies", band, "parameters.band")]


def _deviation(asked, name):
    """Return the tolerance of a value as text, or "" if it has none."""
    tolerance = asked["tolerances"].get(name) if name != "mass" else None
    return f" ± {percent(tolerance)}" if tolerance else ""
