"""Claims: every verdict follows from the data and changes with the data.

The data are made up (`helpers.made_up.world`) such that all claims are reproduced.
"""

import math
import re

import numpy as np
import pytest
from helpers import configurations
from helpers.changes import (
    assign,
    copy,
    each,
    early,
    fourth,
    power,
    put,
    renamed,
    scale,
    share,
    unstable,
)
from helpers.made_up import PEAKS, damped_branches, subharmonic, world

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import (
    DIFFERENT,
    NOT_DECIDABLE,
    NOT_REPRODUCED,
    REPRODUCED,
    Claim,
    Measure,
    Missing,
)
from chatterjee1995.claims.extract import ELASTIC
from chatterjee1995.claims.suppression import suppression_band
from chatterjee1995.claims.verdicts import CLAIMS, claims, document, title, typeset
from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Oscillator
from impact_damper.motions.steady import steady_motion
from impact_damper.orbits.orbit_branch import orbit_branch

BY_NUMBER = {claim.number: claim for claim in CLAIMS}


@pytest.fixture
def data():
    return world()


@pytest.fixture(scope="module")
def table():
    """Verdicts on the unchanged made-up data."""
    return claims(world())


@pytest.fixture(scope="module")
def evidence():
    """Values of the measures from the unchanged made-up data, by number of the claim."""
    return {claim.number: claim.evidence(world()) for claim in CLAIMS}


# Changes of the data with which each claim is not reproduced.
REFUTED = {
    "1": scale("harmonic_balance", "figure_03a_rule", quiet_amplitude=1000),
    "2": scale("harmonic_balance", "figure_05a", rigid_amplitude=1.1),
    "3": assign("harmonic_balance", "figure_03b", stability=flag("stability", "unstable")),
    "4": scale("harmonic_balance", "figure_05c", band_width=0.1),
    "5": assign("branches", "figure_05b", orbit_contacts=3.0),
    "6": each(ELASTIC, lambda name: scale("response", name, contacts=0.5)),
    "7": scale("branches", "figure_05a", orbit_phase_relative=0.5),
    "8": scale("collisions", "figure_05a", colliding=0.5),
    "9": scale("optimum", "0.215_0.12_1.0", optimum_clearance=0.9),
    "10": copy("branches", "figure_05b", "figure_05c"),
    "11": copy("branches", "figure_10", "figure_05c"),
    "12": share("figure_13", "quiet", 0.1),
    "13": share("figure_15", "quiet", 0.0),
    "14": scale("migration", "figure_15", within_share=0),
    "15": renamed("response", "figure_10", restitution=0.2),
    "16": each(ELASTIC, lambda name: scale("harmonic_balance", name, edge_frequency=[0.2, 1])),
    "17": scale("branches", "figure_05c", orbit_displacement=10),
    "18": put("subharmonic", "figure_05a", subharmonic("figure_05a")),
    "19": early(0),
    "S1": power,
    "S2": renamed("harmonic_balance", "figure_03a", clearance=0.69),
    "S3": fourth,
    "S4": renamed("harmonic_balance", "figure_05a", clearance=3),
    "S5": scale("branches", "free_h150", event_value=1.02),
    "S6": renamed("optimum", "0.215_0.12_0.75", frequency=1.0),
}

# Changes of the data with which a claim is reproduced with a difference.
DIFFERENCES = {
    "3": unstable("figure_05a", 0.8, 0.85),
    "4": assign("design_orbit", "figure_03b", orbit_multiplier_real=1.01),
    "6": assign("response", "figure_05b", outcome=flag("outcome", "chaotic")),
    "8": scale("collisions", "figure_05a", colliding=0.995),
    "9": scale("optimum", "0.215_0.12_1.0", quiet_displacement=1.5, optimum_displacement=1.5),
    "11": scale("optimum", "0.215_0.12_0.75", quiet_displacement=1.5),
    "14": scale("migration", "figure_13", within_share=0.4),
    "16": scale("branches", "figure_08", orbit_displacement=2),
    "17": scale("optimum", "0.215_0.18_1.0", quiet_displacement=1.08),
    "18": put("branches", "figure_08", damped_branches("figure_08", 0.107, third=0.8)),
    "19": scale("migration", "figure_16", reached_share=0.9),
}


def test_every_claim_misprint_and_gap_is_there_in_order():
    numbers = [str(k) for k in range(1, 20)] + [f"S{k}" for k in range(1, 7)]
    assert [claim.number for claim in CLAIMS] == numbers


def test_all_are_reproduced_in_a_world_made_so(table):
    # Claim 15 computes the time in contact and S5 the peak by closed forms. So their verdicts do
    # not follow from the made-up data.
    expected = dict.fromkeys(BY_NUMBER, REPRODUCED) | {"15": DIFFERENT}
    expected |= {f"S{k}": "the print is consistent" for k in range(1, 4)}
    expected["S4"] = "the printed value is a right rounding"
    expected["S5"] = "a printed value is wrong"
    expected["S6"] = "the values chosen are consistent"
    assert dict(zip(table.number, table.verdict, strict=True)) == expected
    assert table.finding.str.endswith(".").all()
    assert (table.evidence != "").all()


@pytest.mark.parametrize("number", BY_NUMBER)
def test_data_refute(number, data, table):
    REFUTED[number](data)
    row = BY_NUMBER[number].judge(data)
    assert row["verdict"] == BY_NUMBER[number].words[NOT_REPRODUCED], row["evidence"]
    assert [row["finding"]] != list(table.finding[table.number == number])


@pytest.mark.parametrize("number", DIFFERENCES)
def test_data_make_a_difference(number, data):
    DIFFERENCES[number](data)
    row = BY_NUMBER[number].judge(data)
    assert row["verdict"] == DIFFERENT, row["evidence"]


@pytest.mark.parametrize("number", BY_NUMBER)
def test_missing_data_leave_it_open(number):
    row = BY_NUMBER[number].judge({})
    assert row["verdict"] == NOT_DECIDABLE
    assert row["finding"].startswith("There ")


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.number)
def test_evidence_and_measures_have_the_same_names(claim, evidence):
    assert {measure.name for measure in claim.measures} <= set(evidence[claim.number])
    assert any(measure.decisive for measure in claim.measures)


def fitting(claim):
    """Return made-up evidence within all bounds of a claim."""
    values = dict.fromkeys((measure.name for measure in claim.measures), 0.0)
    for measure in claim.measures:
        values[measure.name] = np.clip(values[measure.name], measure.least, measure.most)
    return values


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.number)
def test_made_up_evidence_flips_the_verdict(claim):
    values = fitting(claim)
    assert claim.verdict(values) == REPRODUCED
    for measure in claim.measures:
        if measure.requirement:
            finite = math.isfinite(measure.least)
            beyond = measure.least - 1 if finite else measure.most + 1
            decisive = any(
                same.decisive and not same.holds(beyond)
                for same in claim.measures
                if same.name == measure.name
            )
            expected = NOT_REPRODUCED if decisive else DIFFERENT
            assert claim.verdict(values | {measure.name: beyond}) == expected
            assert claim.verdict(values | {measure.name: math.nan}) == NOT_DECIDABLE


# Names with an underscore that may occur in a sentence, because the paper uses them as symbols.
SYMBOLS = {"omega_l"}


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.number)
def test_a_sentence_for_each_verdict_says_its_reason(claim, evidence):
    """A number beyond its bounds changes the sentence; an unknown number is named in it."""
    values = evidence[claim.number] | fitting(claim)
    told = {claim.sentence(values)}
    for measure in claim.measures:
        if measure.requirement:
            unknown = claim.sentence(values | {measure.name: math.nan})
            assert unknown.startswith("The data do not determine: ")
            assert measure.description in unknown
            beyond = measure.least - 0.5 if math.isfinite(measure.least) else measure.most + 0.5
            changed = claim.sentence(values | {measure.name: beyond})
            assert changed != claim.sentence(values), measure.name
            told.add(changed)
        else:
            told.add(claim.sentence(values | {measure.name: math.nan}))
    for sentence in told:
        assert sentence.endswith(".") and "nan" not in sentence.replace("resonan", ""), sentence
        assert set(re.findall(r"[A-Za-z]+_\w+", sentence)) <= SYMBOLS, sentence
        assert re.search(r"\d|all|none", sentence), sentence


def test_claims_are_shown_by_figures_of_the_configuration():
    figures = configurations.read()["figures"]
    assert {name for claim in CLAIMS for name in claim.figures} <= figures.keys()


def test_page_has_verdict_sentence_figure_and_folded_numbers_of_each_claim(table):
    page = document(table)
    for row in table.map(typeset).to_dict("records"):
        _, _, section = page.partition(f"\n## {title(row['number'])}\n")
        section = section.partition("\n## ")[0]
        top, _, folded = section.partition("<details>")
        assert row["claim"] in top and row["finding"] in top and row["interpretation"] in top
        assert row["verdict"].capitalize() in top
        assert all(f"figures/{name}.png" in top for name in row["figures"].split())
        assert row["criterion"] in folded
    assert page.count("<details>") == len(table)
    assert page.count("*Figure 6*") == page.count("figures/figure_06.png") > 0
    few = document(table, drawn=["figure_06"])
    assert set(re.findall(r"figures/(\w+)\.png", few)) == {"figure_06"}
    assert typeset("rm W^2 d0 = pi^2/8, omega_l >= sqrt(2)") == "rm W² d0 = π²/8, ωl ≥ √(2)"


SHARP = Measure("sharp", "the sharp number", most=1.0, decisive=True)
FULL = Measure("full", "the full number", least=0.0, most=2.0)
NOTE = Measure("note", "the note")


def made_up(evidence):
    """Return a claim with the measures above, for this evidence."""
    return Claim(
        "1", "", "", "", (SHARP, FULL, NOTE),
        evidence=lambda datasets: evidence,
        finding=lambda sharp, **others: f"The number is {sharp}.",
    )  # fmt: skip


@pytest.mark.parametrize(
    "values, verdict",
    [
        ((1.0, 2.0, math.nan), REPRODUCED),
        ((1.0, 2.1, 0.0), DIFFERENT),
        ((1.1, 1.0, 0.0), NOT_REPRODUCED),
        ((1.1, math.nan, 0.0), NOT_REPRODUCED),
        ((math.nan, 1.0, 0.0), NOT_DECIDABLE),
        ((1.0, math.nan, 0.0), NOT_DECIDABLE),
    ],
)
def test_verdict(values, verdict):
    evidence = dict(zip(("sharp", "full", "note"), values, strict=True))
    claim = made_up(evidence)
    assert claim.judge({})["verdict"] == verdict


def test_words():
    evidence = {"sharp": 1.23456, "full": math.nan, "note": math.nan}
    row = made_up(evidence).judge({})
    assert row["criterion"] == (
        "Required: the sharp number, at most 1. For full agreement: the full number, from 0 to 2."
    )
    assert row["evidence"] == "the sharp number: 1.235; the full number: none; the note: none"
    assert row["finding"] == "The number is 1.23456."
    row = made_up(evidence | {"sharp": 1.0}).judge({})
    assert row["finding"] == "The data do not determine: the full number."


def test_suppression_band(data):
    """The band begins above the last violent orbit or chaotic motion.

    The end of chaotic motions is known only to a step of the grid of frequencies.
    """
    peak = PEAKS[0.215]
    band = suppression_band(data, "figure_05a")
    assert band.lower == pytest.approx(0.95 * peak)
    assert band.width == pytest.approx(0.05 * peak)
    assert band.resolution == 0
    response = data["response"]["figure_05a"]
    chaos = np.abs(response.frequency / peak - 0.96) < 0.001
    wild = response.assign(
        outcome=response.outcome.where(~chaos, flag("outcome", "chaotic")),
        maximum_displacement=response.maximum_displacement.where(~chaos, 2.0),
        contacts=response.contacts.where(~chaos, 4.0),
    )
    band = suppression_band(data | {"response": {"figure_05a": wild}}, "figure_05a")
    assert band.lower == pytest.approx(0.96 * peak)
    assert band.least_width == pytest.approx(0.035 * peak)


def test_band_without_high_motions_has_no_lower_edge(data):
    unstable("figure_05a", 0.4, 1.6)(data)
    calm = data["response"]["figure_05a"]
    calm = calm.assign(contacts=calm.contacts.where(calm.contacts != 4, np.nan))
    band = suppression_band(data | {"response": {"figure_05a": calm}}, "figure_05a")
    assert np.isnan(band.lower) and np.isnan(band.width)


def test_a_quiet_orbit_is_stable_and_smaller_than_half_the_resonance(data):
    curve = exact_orbits.of_curve(data, "figure_05a")
    quiet = exact_orbits.quiet(*curve)
    assert exact_orbits.ranges(quiet) == [pytest.approx([1.0, 3.0])]
    assert quiet["size"].max() < 0.2
    unstable("figure_05a", 0.8, 0.9)(data)
    broken = exact_orbits.ranges(exact_orbits.quiet(*exact_orbits.of_curve(data, "figure_05a")))
    assert np.ravel(broken) == pytest.approx([1.0, 1.6, 1.8, 3.0], abs=0.02)
    assert exact_orbits.covered(exact_orbits.high(*curve), 1.5, 2.0) == pytest.approx(0.4)


def test_between_neighbouring_orbits_a_straight_line_is_close():
    """Interpolated orbits agree with motions simulated at frequencies between two orbits.

    The stable parts of the branch end at its folds.
    """
    oscillator, span = Oscillator(damping=0.215), (1.2, 2.6)
    free = orbit_branch(oscillator, None, 1.8, (2.2, 0.1), span=span)
    part = exact_orbits.pieces(free)
    part = part[part.stable]
    end, _ = exact_orbits.resonance_fold(free)
    assert exact_orbits.ranges(part[part["size"] > 1.2]) == [pytest.approx([span[0], end])]
    first = float(free.event_value.min())
    assert exact_orbits.ranges(part[part["size"] < 1.2]) == [pytest.approx([first, span[1]])]
    for frequency in (1.51, 1.77):
        motion = steady_motion(oscillator, None, frequency, (2.2, 0.1))
        size = exact_orbits.resonance(free, [frequency])
        assert size == pytest.approx(float(motion.maximum_displacement), rel=1e-3)
    assert np.isnan(exact_orbits.resonance(free, [2.2]))


def test_release_phase_decides_in_the_nearest_range_of_all_scans(data):
    values = BY_NUMBER["13"].evidence(data)
    assert (values["quiet_first"], values["quiet_last"]) == (1.65, 1.8)
    assert (values["unsettled_first"], values["unsettled_last"]) == (1.5, 1.8)
    assert values["quiet_most"] == pytest.approx(0.8)


def test_release_scans_of_another_damper_tell_nothing(data):
    for name in ("wide", "close"):
        renamed("release_scan", name, clearance=1.0)(data)
    row = BY_NUMBER["13"].judge(data)
    assert row["verdict"] == REPRODUCED
    assert "and some to period 3: none" in row["evidence"]


def test_unknown_dataset_is_named():
    with pytest.raises(Missing, match="no dataset harmonic_balance/figure_05a"):
        extract.get({}, "harmonic_balance", "figure_05a")
