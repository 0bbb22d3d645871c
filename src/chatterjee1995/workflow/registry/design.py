"""Chapter of the report: schematics of the models, and harmonic balance.

A function with the name of a stage returns the parameters of its job for an entry of the
configuration.
"""

from chatterjee1995.workflow.registry.records import PANELS, Kind, Stage, Table
from chatterjee1995.workflow.registry.values import frequencies, search, settling, system


def harmonic_balance(config, name):
    curve = config["curves"][name]
    return system(config, curve) | {"frequencies": frequencies(config, curve, "harmonic_balance")}


def design_orbit(config, name):
    return system(config, config["curves"][name]) | {
        "search": search(config, "sweep_starts"),
        "settling": settling(config),
    }


def harmonic_convergence(config, name):
    entry = config["harmonic_convergence"][name]
    return system(config, entry) | {
        key: entry[key] for key in ("frequency", "highest", "highest_cold")
    }


TITLE = "Models and harmonic balance"
STAGES = (
    Stage("harmonic_balance", "curves", harmonic_balance),
    Stage("design_orbit", "curves", design_orbit),
    Stage("harmonic_convergence", "harmonic_convergence", harmonic_convergence),
)
KINDS = (
    Kind("schematic", (), module="chatterjee1995.figures.schematics", most=1),
    Kind("harmonic_balance", ("harmonic_balance",), PANELS.format("harmonic_balance")),
    Kind("harmonic_convergence", ("harmonic_convergence",), most=5),
)
TABLES = (
    Table(
        "harmonic_balance",
        "chatterjee1995.tables.design",
        ("harmonic_balance", "design_orbit"),
        "Clearance by (19), amplitude by harmonic balance and exact quiet orbit of each curve.",
    ),
    Table(
        "harmonic_convergence",
        "chatterjee1995.tables.design",
        ("harmonic_convergence",),
        "Harmonics that a balance needs for an accuracy, decrease of errors as observed and as "
        "predicted, and cold starts: Newton's method begun from the solution with one harmonic.",
    ),
)
