"""Registry of all claims of Chatterjee, Mallik and Ghosh (1995), and the table of verdicts.

Slips are misprints and gaps of the paper.
"""

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
from impact_damper.data.table_files import as_markdown

MODULES = (
    balance,  # 1, 2, 3
    bands,  # 4, 16, 17
    motions,  # 5, 6, 8
    phases,  # 7
    optimum,  # 9, 11
    subharmonic,  # 10, 18
    migration,  # 12, 13, 14, 19
    contact,  # 15
    slips,  # S1 to S6
)


def _order(claim):
    """Sort key: claims 1 to 19 before slips S1 to S6."""
    return claim.number.startswith("S"), int(claim.number.removeprefix("S"))


CLAIMS = tuple(sorted((claim for module in MODULES for claim in module.CLAIMS), key=_order))


def claims(datasets) -> pd.DataFrame:
    """Table of verdicts: a row for each claim, then one for each slip.

    Parameters
    ----------
    datasets : dict of dict of xarray.Dataset
        Keyed by stage, then by name. A claim whose datasets are missing is not decidable.
    """
    return pd.DataFrame([claim.judge(datasets) for claim in CLAIMS])


def document(frame) -> str:
    """Table of verdicts in Markdown: a summary, then a section for each claim."""
    slips = frame["number"].str.startswith("S")
    parts = [
        "# Claims of the paper, and verdicts from the data",
        f"Claims: {_tally(frame[~slips])}. Slips: {_tally(frame[slips])}.",
        "S1 to S6 are misprints and gaps of the paper, each taken as the claim that the print is "
        "correct.",
        as_markdown(frame[["number", "claim", "verdict"]]),
    ]
    for row in frame.to_dict("records"):
        parts.append(f"## {row['number']}. {row['claim']}")
        entries = [("Verdict", row["verdict"] + ". " + row["difference"])]
        entries += [
            (name.capitalize(), row[name]) for name in ("source", "interpretation", "criterion")
        ]
        entries.append(("Evidence", row["evidence"].replace("; ", ";\n  ")))
        parts.append("\n".join(f"- **{name}:** {text.strip()}" for name, text in entries if text))
    return "\n\n".join(parts)


def _tally(frame):
    """Number of claims with each verdict, as text."""
    counts = frame["verdict"].value_counts()
    return ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS if verdict in counts)
