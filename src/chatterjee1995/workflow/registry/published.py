"""Chapter of the report: numbers that others published, beside the numbers computed here.

The function `published` returns the parameters of the job for an entry of the configuration.
"""

from chatterjee1995.workflow.registry.records import Kind, Stage, Table
from chatterjee1995.workflow.registry.values import settling


def published(config, name):
    return {
        "settings": config["published"][name],
        "seed": config["seed"],
        "settling": settling(config),
    }


TITLE = "Published numbers beside ours"
STAGES = (Stage("published", "published", published, paper=False),)
KINDS = (Kind("published", ("published",), most=1),)
TABLES = (
    Table(
        "published",
        "chatterjee1995.tables.published",
        ("published",),
        "Published numbers and closed forms beside the numbers computed here, and why they differ.",
    ),
)
