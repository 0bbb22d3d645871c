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
        "bands",
        "chatterjee1995.tables.responses",
        ("harmonic_balance", "branches", "response"),
        "Suppression bands by harmonic balance and by the motions found.",
    ),
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
        "tori",
        "chatterjee1995.tables.motions",
        ("branches",),
        "Tori that split off from stable orbits at their Neimark-Sacker points. The growth is the "
        "change of the logarithm of the amplitude in a period, divided by the square of the "
        "amplitude; if it is negative the torus is stable. Motions on stable tori were simulated "
        "at two Ω near the point; the table gives the nearer Ω. The rotation number is "
        "extrapolated to the point, where it must equal the angle of the multiplier. The second "
        "frequency is missing if no torus was found at these Ω, because the orbit ends, or because "
        "the torus locks or becomes chaotic too soon. The kind of a torus is not found out if a "
        "grazing or the resonance 1:3 is too close. Orbits that are unstable on both sides of "
        "their point are left out.",
    ),
    Table(
        "shares",
        "chatterjee1995.tables.motions",
        ("response", "optimum"),
        "Motions to which at least 5 % of random starts lead at some Ω or d0: the largest share of "
        "starts with its 95 % interval, and the bound on the share of a motion to which no start "
        "led.",
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
        "begins at a settled motion, at a stable orbit that Newton's method found in one of 360 "
        "searches from random states, or at a point of another branch: where an orbit loses its "
        "symmetry or doubles its period (table `other_branches`), or where the other branch ends. "
        "A branch has at most 8000 orbits in one direction, or 4400 if its period is above 8. A "
        "branch whose period is above 15 is left where it becomes unstable. Newton's method finds "
        "no next orbit where several contacts appear at almost the same frequency. The column "
        "`not located` of the CSV counts events that lie between two orbits but were not located.",
    ),
    Table(
        "bifurcations",
        "chatterjee1995.tables.branches",
        ("branches",),
        "Located bifurcations and changes of contact next to stable periodic orbits; the CSV has "
        "those of unstable orbits too. An event at which two branches meet has a row for each.",
    ),
    Table(
        "other_branches",
        "chatterjee1995.tables.branches",
        ("branches",),
        "What became of the branches that leave where an orbit loses its symmetry or doubles its "
        "period. An orbit of every such branch is searched for close to the event. A branch is "
        "followed up to period 3, up to period 4 if it leaves next to stable orbits, and up to "
        "period 9 if it is stable where it begins. Other branches are left, since doublings form "
        "infinite cascades and unstable orbits of long periods wind through chaos. A branch is "
        "supercritical if it exists on the side of the event on which the first orbit is more "
        "unstable, and subcritical if it exists on the other side. The side is not determined near "
        "a grazing, since the multipliers change too fast there.",
    ),
)
