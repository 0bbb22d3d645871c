"""Chapter of the report: machines in SI units, beside the paper."""

from impact_damper.workflow.registry.records import Kind, Stage, Table
from impact_damper.workflow.registry.values import grid, settling


def machines(config, name):
    entry = config["machines"][name]
    return {key: entry[key] for key in ("machine", "damper", "frequency", "starts")} | {
        "frequencies": grid(entry["frequencies"], entry["frequencies"]["points"]),
        "gaps": grid(entry["gaps"], entry["gaps"]["points"]),
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
