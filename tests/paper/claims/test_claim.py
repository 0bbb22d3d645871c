"""Texts and bounds of the claims, the rules of verdicts, and the page."""

import math
import re

import pytest
from helpers import configurations
from helpers.made_up import world

from chatterjee1995.claims.claim import (
    DIFFERENT,
    NOT_DECIDABLE,
    NOT_REPRODUCED,
    REPRODUCED,
    Bound,
    Claim,
)
from chatterjee1995.claims.misprints import misrounding
from chatterjee1995.claims.verdicts import CLAIMS, EVIDENCE, claims, document, title, typeset

each_claim = pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.number)


def made_up(sharp, full):
    """Return a claim with two numbers of given values."""
    return Claim(
        "1",
        lambda datasets: {"sharp": sharp, "full": full},
        claim="",
        source="",
        reading="",
        finding="The number is\n{{ sharp|number }}, {{ full|part }}.",
        required={"sharp <= 1": "the sharp number"},
        full_agreement={"0 <= full <= 2": "the full number", "sharp <= 0.9": None},
    )


@pytest.mark.parametrize(
    ("values", "verdict"),
    [
        ((0.9, 2.0), REPRODUCED),
        ((0.9, 2.1), DIFFERENT),
        ((1.0, 2.0), DIFFERENT),
        ((1.1, 1.0), NOT_REPRODUCED),
        ((1.1, math.nan), NOT_REPRODUCED),
        ((math.nan, 1.0), NOT_DECIDABLE),
        ((1.0, math.nan), NOT_DECIDABLE),
    ],
)
def test_verdict(values, verdict):
    assert made_up(*values).judge({})["verdict"] == verdict


def test_words():
    row = made_up(0.123456, 0.5).judge({})
    assert row["criterion"] == (
        "Required: the sharp number, at most 1. "
        "For full agreement: the full number, from 0 to 2; the sharp number, at most 0.9."
    )
    assert row["evidence"] == "the sharp number: 0.1235; the full number: 0.5"
    assert row["finding"] == "The number is 0.123, 50 %."
    assert made_up(1.0, 0.0).judge({})["finding"] == "The number is 1, none."
    row = made_up(1.0, math.nan).judge({})
    assert row["finding"] == "The data do not determine: the full number."


def test_every_claim_misprint_and_gap_is_there_in_order():
    numbers = [str(k) for k in range(1, 20)] + [f"S{k}" for k in range(1, 7)]
    assert [claim.number for claim in CLAIMS] == numbers == list(EVIDENCE)
    figures = configurations.read()["figures"]
    assert {name for claim in CLAIMS for name in claim.figures} <= figures.keys()


@each_claim
def test_a_number_beyond_its_bound_changes_verdict_and_finding(claim):
    values = claim.evidence(world())
    bounds = [Bound.read(text) for text in (*claim.required, *claim.full_agreement)]
    assert {bound.name for bound in bounds} == claim.meanings.keys() <= values.keys()
    inside = values | {
        bound.name: min(max(values[bound.name], bound.least), bound.most) for bound in bounds
    }
    usual = claim.sentences(inside)
    assert usual.endswith(".") and set(re.findall(r"[A-Za-z]+_\w+", usual)) <= {"omega_l"}
    for bound in bounds:
        beyond = bound.least - 0.5 if math.isfinite(bound.least) else bound.most + 0.5
        changed = inside | {bound.name: beyond}
        assert claim.verdict(changed) not in (REPRODUCED, NOT_DECIDABLE)
        # The finding of S5 takes distances from a list, not from the number that has the bound.
        assert claim.sentences(changed) != usual or claim.number == "S5", bound.name


@each_claim
def test_missing_data_leave_it_open(claim):
    row = claim.judge({})
    assert row["verdict"] == NOT_DECIDABLE and row["finding"].startswith("There ")


def test_page_has_verdict_sentence_figure_and_folded_numbers_of_each_claim():
    table = claims(world())
    page = document(table)
    for row in table.map(typeset).to_dict("records"):
        _, _, section = page.partition(f"\n## {title(row['number'])}\n")
        section = section.partition("\n## ")[0]
        top, _, folded = section.partition("<details>")
        assert row["claim"] in top and row["finding"] in top and row["interpretation"] in top
        assert row["verdict"].capitalize() in top
        assert all(f"figures/{name}.png" in top for name in row["figures"].split())
        assert row["criterion"] in folded and row["evidence"].split("; ")[-1] in folded
    assert page.count("<details>") == len(table)
    assert page.count("*Figure 6*") == page.count("figures/figure_06.png") > 0
    few = document(table, drawn=["figure_06"])
    assert set(re.findall(r"figures/(\w+)\.png", few)) == {"figure_06"}
    assert typeset("rm W^2 d0 = pi^2/8, omega_l >= sqrt(2)") == "rm W² d0 = π²/8, ωl ≥ √(2)"


@pytest.mark.parametrize(
    ("printed", "computed", "right"),
    [(2.0, 1.501, True), (2.0, 2.501, False), (2.37, 2.3651, True), (2.37, 2.3649, False)],
)
def test_a_right_rounding_is_within_half_a_unit_of_the_last_digit(printed, computed, right):
    assert (misrounding(printed, computed) <= 1) == right
