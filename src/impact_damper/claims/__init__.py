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
