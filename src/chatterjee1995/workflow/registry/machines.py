"""Chapter of the report: dampers designed for machines in SI units, which the paper does not have.

The function `machines` returns the parameters of the job for an entry of the configuration.
"""

from chatterjee1995.workflow.registry.records import Kind, Stage, Table
from chatterjee1995.workflow.registry.values import settling


def machines(config, name):
    entry, band = config["machines"][name], config["machines"][name]["band"]
    kept = ("machine", "damper", "candidates", "starts", "share", "tolerances")
    return {key: entry[key] for key in kept} | {
        "contact": entry.get("contact"),
        "displacement_limit": entry.get("displacement_limit"),
        "band": [band["first"], band["last"]],
        "frequencies": band["points"],
        "seed": config["seed"],
        "settling": settling(config),
    }


TITLE = "Dampers for machines in SI units"
# Names of the figures of a machine's page, the keys of `pages.machine.FIGURES`.
PAGE = (
    "drawing",
    "response",
    "transients",
    "cliff",
    "tolerances",
    "forces",
    "dampers",
    "competitors",
    "masses",
)
STAGES = (Stage("machines", "machines", machines, paper=False, page=PAGE),)
KINDS = (
    Kind(
        "machines", ("machines",), "impact_damper.plot.machine_figures.overview", most=6, named=True
    ),
)
TABLES = (
    Table(
        "machines",
        "chatterjee1995.tables.machines",
        ("machines",),
        "Dampers designed for machines: the gap to build, displacements over the band, the promise "
        "and its test, and the best tuned absorber of the same mass.",
    ),
)
