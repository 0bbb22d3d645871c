"""Chapter of the report: frequency responses."""

from impact_damper.workflow.registry.records import Kind, Stage, Table
from impact_damper.workflow.registry.values import frequencies, search, settling, system


def response(config, name):
    curve = config["curves"][name]
    points = "simulated" if "mass_ratio" in curve else "free"
    return system(config, curve) | {
        "frequencies": frequencies(config, curve, points),
        "search": search(config, "starts"),
        "settling": settling(config),
    }


def branches(config, name):
    curve = config["curves"][name]
    span = config["oscillators"][curve["oscillator"]]["frequencies"]
    return system(config, curve) | {"frequencies": [span["first"], span["last"]]}


def motion(config, name):
    entry = config["motion"][name]
    return system(config, entry) | {
        "frequency": entry["frequency"],
        "settling": settling(config),
    }


def collisions(config, name):
    entry = config["collisions"][name]
    return system(config, entry) | {
        "frequency": entry["frequency"],
        "radius": config["search"]["radius"],
        "seed": config["seed"],
    }


TITLE = "Frequency responses"
STAGES = (
    Stage("response", "curves", response),
    Stage("subharmonic", "curves", response),
    Stage("branches", "curves", branches, reads=("response", "subharmonic")),
    Stage("motion", "motion", motion),
    Stage("collisions", "collisions", collisions),
)
KINDS = (
    Kind("free", ("branches",), damper=False),
    Kind("motion", ("motion",)),
    Kind("response", ("response", "harmonic_balance", "subharmonic", "branches")),
    Kind("branches", ("branches",)),
)
TABLES = (
    Table(
        "bands",
        "tables.responses",
        ("harmonic_balance", "branches", "response"),
        "Suppression bands by harmonic balance and by the motions that exist.",
    ),
    Table(
        "subharmonic",
        "tables.responses",
        ("branches", "subharmonic"),
        "The one-third subharmonic without damper, and its stable branches with damper.",
    ),
    Table(
        "orbits",
        "tables.responses",
        ("branches",),
        "Branches of periodic orbits: range, stable parts, and events at both ends.",
    ),
    Table(
        "bifurcations",
        "tables.responses",
        ("branches",),
        "All located bifurcations and changes of contact of the periodic orbits.",
    ),
)
