"""Every claim of Chatterjee, Mallik and Ghosh (1995), judged by the datasets."""

import pandas as pd

from impact_damper.claims import (
    balance,
    bands,
    contact,
    migration,
    motions,
    optimum,
    phases,
    slips,
    subharmonic,
)
from impact_damper.claims.claim import VERDICTS
from impact_damper.data.table_files import plain

MODULES = (balance, bands, contact, migration, motions, optimum, phases, slips, subharmonic)
CLAIMS = tuple(
    sorted(
        (claim for module in MODULES for claim in module.CLAIMS),
        key=lambda claim: (claim.number.startswith("S"), int(claim.number.removeprefix("S"))),
    )
)


def claims(datasets) -> pd.DataFrame:
    """The claims table: a row for each claim, then one for each slip.

    Parameters
    ----------
    datasets : dict
        By stage and name, as the workflow makes them; a claim whose datasets are missing
        is not decidable.
    """
    return pd.DataFrame([claim.judge(datasets) for claim in CLAIMS])


def document(frame) -> str:
    """The claims table in Markdown: the verdicts at a glance, then a section for each claim."""
    slips = frame["number"].str.startswith("S")
    parts = [
        "# What the paper states, and what the data say",
        f"Claims: {_tally(frame[~slips])}. Slips: {_tally(frame[slips])}.",
        "S1 to S6 are slips of the paper, each taken as the claim that what is printed holds.",
        plain(frame[["number", "claim", "verdict"]]),
    ]
    for row in frame.to_dict("records"):
        parts.append(f"## {row['number']}. {row['claim']}")
        entries = [("Verdict", row["verdict"] + ". " + row["difference"])]
        entries += [(name.capitalize(), row[name]) for name in ("source", "reading", "criterion")]
        entries.append(("Evidence", row["evidence"].replace("; ", ";\n  ")))
        parts.append("\n".join(f"- **{name}:** {text.strip()}" for name, text in entries if text))
    return "\n\n".join(parts)


def _tally(frame):
    counts = frame["verdict"].value_counts()
    return ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS if verdict in counts)
