"""Chapter of the report: frequency responses.

A function with the name of a stage returns the parameters of its job for an entry of the
configuration.
"""

from chatterjee1995.workflow.registry.records import PANELS, Kind, Stage, Table
from chatterjee1995.workflow.registry.values import frequencies, search, settling, system


def response(config, name):
    lives = {key: config["search"][key] for key in ("life_runs", "life_periods")}
    return curve_motions(config, name) | {"lives": lives}


def curve_motions(config, name):
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
    Stage("subharmonic", "curves", curve_motions),
    Stage("branches", "curves", branches, reads=("response", "subharmonic")),
    Stage("motion", "motion", motion),
    Stage("collisions", "collisions", collisions),
)
KINDS = (
    Kind("free", ("branches",), damper=False),
    Kind("motion", ("motion",), PANELS.format("motion")),
    Kind(
        "response",
        ("response", "harmonic_balance", "subharmonic", "branches"),
        PANELS.format("response"),
    ),
    Kind("branches", ("branches",), PANELS.format("branches")),
    Kind("shares", ("response",), PANELS.format("shares")),
)
TABLES = (
    Table(
        "outcomes",
        "chatterjee1995.tables.motions",
        ("response", "subharmonic", "optimum", "studies", "balance_map"),
        "Number of random starts with each outcome, for each dataset. The figures draw motions "
        "without contact that still drift as motions without contact. They also draw motions that "
        "were found by following, to which no start led; these are not counted here. The CSV file "
        "also counts unresolved motions by the sign of their Lyapunov exponent.",
    ),
    Table(
        "quasi_periodic",
        "chatterjee1995.tables.motions",
        ("response",),
        "Quasi-periodic motions of the responses and their two frequencies, from rotation numbers.",
    ),
    Table(
        "chaos",
        "chatterjee1995.tables.motions",
        ("response", "branches"),
        "Chaotic motions of the responses that are larger than half of the free resonance, and "
        "their mean lives with 95 % intervals. If chaos ended in no run, the mean life is empty "
        "and the upper end is infinite.",
    ),
    Table(
        "subharmonic",
        "chatterjee1995.tables.responses",
        ("branches", "subharmonic"),
        "The one-third subharmonic without damper, and its stable branches with damper.",
    ),
    Table(
        "orbits",
        "chatterjee1995.tables.branches",
        ("branches",),
        "Branches of periodic orbits: range, stable parts, and events at both ends. A branch "
        "begins at a settled motion or at a point of another branch: where an orbit loses its "
        "symmetry or doubles its period, or where the other branch ends. A branch of period 1 is "
        "followed to its ends, any other until 300 forcing cycles of unstable orbits lie behind "
        "each other. Newton's method finds no next orbit where several contacts appear at almost "
        "the same frequency. The column "
        "`not located` of the CSV counts events that lie between two orbits but were not located.",
    ),
    Table(
        "bifurcations",
        "chatterjee1995.tables.branches",
        ("branches",),
        "Located bifurcations and changes of contact next to stable periodic orbits; the CSV has "
        "those of unstable orbits too. An event at which two branches meet has a row for each.",
    ),
)
