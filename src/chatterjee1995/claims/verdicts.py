"""Registry of all claims of Chatterjee, Mallik and Ghosh (1995), and the table of verdicts.

Misprints and omissions of the paper, S1 to S6, are called slips in the names of the code.

A stage is a step of the workflow.
"""

import re

import pandas as pd

from chatterjee1995.claims import (
    amplitude,
    balance,
    bands,
    coexistence,
    contact,
    migration,
    motions,
    optimum,
    phases,
    release,
    slips,
    subharmonic,
)
from impact_damper.data.table_files import as_markdown, in_words

MODULES = (
    balance,  # 1, 2
    coexistence,  # 3
    bands,  # 4, 16
    amplitude,  # 17
    motions,  # 5, 6, 8
    phases,  # 7
    optimum,  # 9, 11
    subharmonic,  # 10, 18
    release,  # 12, 13
    migration,  # 14, 19
    contact,  # 15
    slips,  # S1 to S6
)


def _order(claim):
    """Return the sort key of a claim: claims 1 to 19 come before S1 to S6."""
    return claim.number.startswith("S"), int(claim.number.removeprefix("S"))


CLAIMS = tuple(sorted((claim for module in MODULES for claim in module.CLAIMS), key=_order))


def claims(datasets) -> pd.DataFrame:
    """Return the table of verdicts, with a row for each claim and each misprint or omission.

    Parameters
    ----------
    datasets : dict of dict of xarray.Dataset
        Keyed by stage, then by name. A claim whose datasets are missing is not decidable.
    """
    return pd.DataFrame([claim.judge(datasets) for claim in CLAIMS])


# Introduction of the page: words and symbols of all claims.
READING = """\
S1 to S6 are places of the paper that look like a misprint or an omission, each taken as the \
claim that the print is correct. A claim is reproduced if all that is required and all that full \
agreement demands hold, reproduced with a difference if only what is required holds, and \
otherwise not reproduced. In the findings bounds and ends of ranges are rounded outward.

W is the forcing frequency, Ω in the figures, and Wp its value at the peak of the resonance \
without the damper. Z1 is the displacement of the primary mass, Z2 its displacement relative to \
the loose mass; a and b are their amplitudes by harmonic balance. h is the damping, omega_l^2 \
the linear stiffness, rm the mass ratio, d0 half the gap, and e the restitution. (7), (14) and \
(19) are equations of the paper: harmonic balance, its limit of rigid walls, and the rule rm \
Wp^2 d0 = 1 for the clearance.

A motion is violent if its max |Z1| is above half of the free resonance at the same W, the \
resonance branch without the damper; for solutions of (7) |a| counts. Above the end of this \
branch no motion is called violent. A quiet motion has period 1, touches the walls and is not \
violent. In all claims the suppression band is the range of W around Wp, up to the end of the \
free resonance, in which no motion with the damper is violent. By (7) the quiet motion is the \
only stable one with contact in the band; a motion without contact may coexist. In the \
simulations other motions that are not violent coexist with it, such as the subharmonics that the \
paper finds within the band of figure 5 (c)."""


def document(frame, picture=None, drawn=None) -> str:
    """Return the page of the claims in Markdown: a summary, then a section for each claim.

    A section has the claim, the verdict, what the data show, the figures that show it and our
    reading of the claim. A folded part has the criterion and its numbers.

    Parameters
    ----------
    frame : pandas.DataFrame
        As `claims` returns it, or as read from its file.
    picture : callable, optional
        Maps the name of a figure to the Markdown that shows it. By default this is an image in
        the folder `figures`, which lies beside the folder of the page.
    drawn : container of str, optional
        Names of the figures that exist; others are left out. By default all exist.
    """
    picture = picture or (lambda name: f"![{name}](../figures/{name}.png)")
    slips = frame["number"].str.startswith("S")
    parts = [
        "# The paper, claim by claim",
        f"Claims: {_tally(frame[~slips])}. Misprints and omissions: {_tally(frame[slips])}.",
        READING,
        as_markdown(
            frame[["number", "claim", "verdict"]].assign(number=frame["number"].map(_link))
        ),
    ]
    for row in frame.to_dict("records"):
        numbers = "".join(f"\n  - {each}" for each in row["evidence"].split("; ") if each)
        parts += [
            f"## {title(row['number'])}",
            f"> {row['claim']}",
            f"**{row['verdict'].capitalize()}.** {row['finding']}",
            *[
                f"{shown.strip()}\n\n*{_label(name)}*"
                for name in row["figures"].split()
                if (drawn is None or name in drawn) and (shown := picture(name))
            ],
            f"*Our reading:* {row['interpretation']}",
            "<details><summary>Criterion and numbers</summary>",
            f"- **In the paper:** {row['source']}\n- **Criterion:** {row['criterion']}"
            f"\n- **Numbers:**{numbers or ' none'}",
            "</details>",
        ]
    return typeset("\n\n".join(part for part in parts if part))


# Regular expressions for symbols in plain text, with the printed symbols.
PRINTED = {"omega_l": "ωl", r"\bpi\b": "π", r"\^2\b": "²", r"\bsqrt\b": "√", ">=": "≥"}


def typeset(text) -> str:
    """Return a text with printed symbols (PRINTED)."""
    for plain, printed in PRINTED.items():
        text = re.sub(plain, printed, text)
    return text


def title(number):
    """Return the heading of the section of a claim, or of a misprint or omission."""
    return f"Misprint or omission {number}" if number.startswith("S") else f"Claim {number}"


def _label(name):
    """Return the line below a figure, such as "Figure 5 (a)" or "Orbits 05a"."""
    words = in_words(name)
    return words[0].upper() + words[1:]


def _link(number):
    """Return the number of a claim as a Markdown link to its section."""
    return f"[{number}](#{title(number).lower().replace(' ', '-')})"


def _tally(frame):
    """Return the verdicts as text, each with the number of its claims."""
    counts = frame["verdict"].value_counts()
    return ", ".join(f"{verdict} ({number})" for verdict, number in counts.items())
