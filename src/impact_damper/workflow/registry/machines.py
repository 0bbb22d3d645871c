"""Chapter of the report: dampers designed for machines in SI units, beside the paper."""

from impact_damper.workflow.registry.records import Kind, Stage, Table
from impact_damper.workflow.registry.values import settling


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


TITLE = "Machines in SI units"
STAGES = (Stage("machines", "machines", machines, paper=False),)
KINDS = (Kind("machines", ("machines",), most=5, named=True),)
TABLES = (
    Table(
        "machines",
        "tables.machines",
        ("machines",),
        "Machines in SI units: what a damper does over the frequency, and the gap at which its "
        "quiet motion is smallest.",
    ),
)
