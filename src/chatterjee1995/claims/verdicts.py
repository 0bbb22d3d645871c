"""All claims of the paper, the table of verdicts on them, and the Markdown page of the claims."""

import re
from importlib.resources import files

import pandas as pd
import yaml
from jinja2 import Environment, StrictUndefined

from chatterjee1995.claims import (
    balance,
    bands,
    migration,
    misprints,
    motions,
    optimum,
    subharmonic,
)
from chatterjee1995.claims.claim import Claim
from chatterjee1995.tables.files import as_markdown, in_words

EVIDENCE = {
    "1": balance.small_motion,
    "2": balance.rigid_against_elastic,
    "3": balance.quiet_and_high,
    "4": bands.widening,
    "5": motions.quiet_contacts,
    "6": motions.high_and_chaotic,
    "7": motions.phases,
    "8": motions.first_collisions,
    "9": optimum.excess,
    "10": subharmonic.reappearance,
    "11": optimum.restitution,
    "12": migration.any_phase,
    "13": migration.release_phase,
    "14": migration.total_cycles,
    "15": motions.contact_model,
    "16": bands.accuracy,
    "17": bands.amplitude_by_mass,
    "18": subharmonic.by_damping,
    "19": migration.early_release,
    "S1": misprints.penetration,
    "S2": misprints.captions,
    "S3": misprints.state_size,
    "S4": misprints.design_point,
    "S5": misprints.peaks,
    "S6": misprints.unprinted,
}
_TEXTS = yaml.safe_load(files(__package__).joinpath("claims.yaml").read_text())
CLAIMS = tuple(
    Claim(str(number), EVIDENCE[str(number)], **entry) for number, entry in _TEXTS["claims"].items()
)
# Regular expression for a symbol in a text -> symbol that replaces it on the page.
PRINTED = {"omega_l": "ωl", r"\bpi\b": "π", r"\^2\b": "²", r"\bsqrt\b": "√", ">=": "≥"}


def claims(datasets) -> pd.DataFrame:
    """Return a table with the verdict on each claim."""
    return pd.DataFrame([claim.judge(datasets) for claim in CLAIMS])


def document(frame, picture=None, drawn=None) -> str:
    """Return the Markdown page of the claims.

    `frame` is the table of claims. `picture(name)` returns the Markdown text that shows a figure,
    by default a link to an image. `drawn` has the names of the figures to show; None shows all.
    """
    picture = picture or (lambda name: f"![{name}](../figures/{name}.png)")
    rows = frame.to_dict("records")
    for row in rows:
        names = [name for name in row["figures"].split() if drawn is None or name in drawn]
        shown = [(picture(name).strip(), in_words(name)) for name in names]
        row["pictures"] = [(text, label[0].upper() + label[1:]) for text, label in shown if text]
    misprints = frame["number"].str.startswith("S")
    links = frame["number"].map(
        lambda number: f"[{number}](#{title(number).lower().replace(' ', '-')})"
    )
    pages = Environment(undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    pages.filters["title"] = title
    page = pages.from_string(files(__package__).joinpath("page.md").read_text())
    text = page.render(
        introduction=_TEXTS["introduction"],
        tally={"claims": _tally(frame[~misprints]), "misprints": _tally(frame[misprints])},
        table=as_markdown(frame[["number", "claim", "verdict"]].assign(number=links)),
        rows=rows,
    )
    return typeset(text.strip())


def typeset(text) -> str:
    """Return a text in which plain symbols, such as "omega_l", are replaced by printed ones."""
    for plain, printed in PRINTED.items():
        text = re.sub(plain, printed, text)
    return text


def title(number) -> str:
    """Return a heading for the number of a claim: "Claim 3", or "Misprint or omission S1"."""
    return f"Misprint or omission {number}" if number.startswith("S") else f"Claim {number}"


def _tally(frame) -> str:
    counts = frame["verdict"].value_counts()
    return ", ".join(f"{verdict} ({number})" for verdict, number in counts.items())
