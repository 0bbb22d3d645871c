"""Chapter of the report: methods compared.

A function with the name of a stage returns the parameters of its job for an entry of the
configuration. The load on a contact is the acceleration that all forces except the contact force
cause.
"""

from chatterjee1995.workflow.registry.records import Kind, Stage, Table
from chatterjee1995.workflow.registry.values import (
    axis,
    grid,
    oscillator,
    settling,
    system,
)
from impact_damper.model.parameters import Damper, Oscillator, pick


def balance_map(config, name):
    entry = config["balance_map"][name]
    given = pick(Oscillator, entry) | pick(Damper, entry)
    # Without a clearance the stage takes the clearance of the paper's rule (19) in each row.
    fixed = {key: value for key, value in given.items() if value != "rule"}
    return {
        "parameter": entry["parameter"],
        "values": grid(entry["values"], config["points"]["map_values"]),
        "frequency_ratios": grid(entry["frequency_ratios"], config["points"]["map_frequencies"]),
        "fixed": {"contact_stiffness": config["contact_stiffness"]} | fixed,
        "settling": settling(config),
    }


def contact_model(config, name):
    entry = config["contact_model"][name]
    cells = entry["cells"]
    return system(config, entry) | {
        "frequencies": entry["frequencies"],
        "used": entry["restitutions"],
        "periods": entry["periods"],
        "starts": config["search"]["scan_starts"],
        "seed": config["seed"],
        "restitutions": [entry["smallest_restitution"], 1, cells["restitutions"]],
        "loads": [entry["largest_load"], cells["loads"]],
        "settling": settling(config),
    }


def rigid_limit(config, name):
    entry = config["rigid_limit"][name]
    return system(config, entry) | {
        "frequency": entry["frequency"],
        "frequencies": grid(entry["frequencies"], entry["cells"]["frequencies"]),
        "stiffnesses": grid(entry["stiffnesses"], entry["cells"]["stiffnesses"]),
        "starts": config["search"]["scan_starts"],
        "seed": config["seed"],
        "settling": settling(config),
    }


def missed_contacts(config, name):
    entry = config["missed_contacts"][name]
    keys = ("frequency", "passages", "radius")
    return {
        "oscillator": oscillator(config, entry["oscillator"]),
        **{key: entry[key] for key in keys},
        "depths": axis(entry["depths"]),
        "tolerances": axis(entry["tolerances"]),
        "steps": grid(entry["steps"], entry["tolerances"]["points"]),
        "seed": config["seed"],
    }


def stable_steps(config, name):
    entry = config["stable_steps"][name]
    return system(config, entry) | {
        **{key: entry[key] for key in ("frequency", "most_steps", "periods")},
        "stiffnesses": axis(entry["stiffnesses"]),
        "scaled_steps": axis(entry["scaled_steps"]),
    }


def accuracy(config, name):
    entry = config["scenes"][name]
    return system(config, entry) | {
        **{key: entry[key] for key in ("frequency", "state", "periods", "motion", "accuracy")},
        "settings": config["comparison"],
    }


TITLE = "Methods compared"
STAGES = (
    Stage("balance_map", "balance_map", balance_map),
    Stage("contact_model", "contact_model", contact_model),
    Stage("rigid_limit", "rigid_limit", rigid_limit),
    Stage("missed_contacts", "missed_contacts", missed_contacts),
    Stage("stable_steps", "stable_steps", stable_steps),
    Stage("accuracy", "scenes", accuracy),
)
KINDS = (
    Kind("balance_map", ("balance_map",), most=1),
    Kind("contact_model", ("contact_model",)),
    Kind("rigid_limit", ("rigid_limit",)),
    Kind("missed_contacts", ("missed_contacts",), most=1),
    Kind("stable_steps", ("stable_steps",)),
    Kind("accuracy", ("accuracy",), named=True),
)
TABLES = (
    Table(
        "balance_map",
        "chatterjee1995.tables.balance_map",
        ("balance_map",),
        "Number of map cells in which harmonic balance is right and wrong about stability.",
    ),
    Table(
        "contact_model",
        "chatterjee1995.tables.contact",
        ("contact_model",),
        "Contacts without load, and number of map cells by error of the restitution, for both "
        "rules for the end of a contact.",
    ),
    Table(
        "rigid_limit",
        "chatterjee1995.tables.contact",
        ("rigid_limit",),
        "Errors of rigid impacts, their order in r1, and number of map cells by error.",
    ),
    Table(
        "missed_contacts",
        "chatterjee1995.tables.integrators",
        ("missed_contacts",),
        "Number of contacts near grazing that each integrator finds and misses.",
    ),
    Table(
        "stable_steps",
        "chatterjee1995.tables.integrators",
        ("stable_steps",),
        "Largest steps with which fixed-step methods keep the quiet motion accurate.",
    ),
    Table(
        "models",
        "chatterjee1995.tables.accuracy",
        ("accuracy",),
        "Error and counted work of every method and model on each test case (scene), and the one "
        "with the least work that is accurate enough.",
    ),
)
