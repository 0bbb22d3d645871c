"""Criteria of claims on harmonic balance: made-up data on both sides of each border.

The data are those of `helpers.made_up.world`, with which all claims are reproduced. A change makes
a criterion just hold or just fail. Wp is the peak frequency without the damper.

Z1 is the displacement of the primary mass, rm the mass ratio and omega_l the linear frequency.
Equation (7) of the paper is harmonic balance with elastic contacts.
"""

import numpy as np
import pytest
from helpers.changes import assign, each, renamed, scale, unstable
from helpers.made_up import LINEAR, PEAKS, world

from chatterjee1995.claims.bands import largest_difference
from chatterjee1995.claims.claim import DIFFERENT, NOT_REPRODUCED, REPRODUCED
from chatterjee1995.claims.extract import ELASTIC
from chatterjee1995.claims.slips import misrounding
from chatterjee1995.claims.suppression import Band
from chatterjee1995.claims.verdicts import CLAIMS
from impact_damper.data.datasets import flag

BY_NUMBER = {claim.number: claim for claim in CLAIMS}


def unstable_balance(ratio):
    """A change of the made-up data: no stable solution of (7) near the frequency `ratio` Wp."""

    def change(data):
        old = data["harmonic_balance"]["figure_03b"]
        kept = np.abs(old.frequency / LINEAR[1.0] - ratio) > 0.01
        stability = old.stability.where(kept, flag("stability", "unstable"))
        data["harmonic_balance"]["figure_03b"] = old.assign(stability=stability)

    return change


def double_period(ratio):
    """A change of the made-up data: a small motion of period 2 near the frequency `ratio` Wp."""

    def change(data):
        old = data["response"]["figure_05a"]
        kept = np.abs(old.frequency / PEAKS[0.215] - ratio) > 0.01
        data["response"]["figure_05a"] = old.assign(period=old.period.where(kept, 2))

    return change


def orbits_times(factor, names=ELASTIC):
    """A change of the made-up data: max |Z1| of exact orbits is multiplied by a factor."""
    return each(names, lambda name: scale("branches", name, orbit_displacement=factor))


def sweep_ratio(factor):
    """A change of the made-up data: the ratio of max |Z1| at rm = 0.18 to 0.12 is `factor`."""
    usual = (0.12 / 0.18) ** 0.25
    return scale("optimum", "0.215_0.18_1.0", quiet_displacement=factor / usual)


# Number of a claim, a change of the data, and the verdict with it.
BORDERS = [
    ("3", unstable_balance(1.12), REPRODUCED),
    ("3", unstable_balance(1.08), NOT_REPRODUCED),
    ("3", unstable("figure_05a", 1.11, 1.2), REPRODUCED),
    ("3", unstable("figure_05a", 1.08, 1.2), DIFFERENT),
    ("3", assign("design_orbit", "figure_03a", orbit_multiplier_real=0.99), REPRODUCED),
    ("3", assign("design_orbit", "figure_03a", orbit_multiplier_real=1.01), DIFFERENT),
    ("3", double_period(0.9), REPRODUCED),
    ("3", double_period(0.97), DIFFERENT),
    # the widths of the band at omega_l = 0 and 1 are 0.1 and 0.126
    ("4", scale("harmonic_balance", "figure_03b", band_width=0.85), REPRODUCED),
    ("4", scale("harmonic_balance", "figure_03b", band_width=0.78), NOT_REPRODUCED),
    ("4", assign("design_orbit", "figure_03b", orbit_multiplier_real=0.99), REPRODUCED),
    ("4", assign("design_orbit", "figure_03b", orbit_multiplier_real=1.01), DIFFERENT),
    ("4", scale("harmonic_balance", "figure_03b_rule", band_width=0.78), NOT_REPRODUCED),
    ("4", scale("harmonic_balance", "figure_03b", reduction=0.91), REPRODUCED),
    ("4", scale("harmonic_balance", "figure_03b", reduction=0.89), NOT_REPRODUCED),
    ("4", scale("design_orbit", "figure_03b", orbit_displacement=4.5), REPRODUCED),
    ("4", scale("design_orbit", "figure_03b", orbit_displacement=6.0), DIFFERENT),
    ("16", orbits_times(1.2), REPRODUCED),
    ("16", orbits_times(1.3, ["figure_08"]), DIFFERENT),
    ("16", orbits_times(1.3), DIFFERENT),
    ("16", orbits_times(0.85), REPRODUCED),
    ("16", orbits_times(0.75), DIFFERENT),
    ("17", sweep_ratio(0.94), REPRODUCED),
    ("17", sweep_ratio(0.96), DIFFERENT),
    ("17", sweep_ratio(1.01), NOT_REPRODUCED),
    ("S2", renamed("harmonic_balance", "figure_03a", clearance=1.58), REPRODUCED),
    ("S2", renamed("harmonic_balance", "figure_03a", clearance=1.57), NOT_REPRODUCED),
    ("S4", renamed("harmonic_balance", "figure_05a", clearance=2), REPRODUCED),
    ("S4", renamed("harmonic_balance", "figure_05a", clearance=2.1), REPRODUCED),
    ("S4", renamed("harmonic_balance", "figure_05a", clearance=2.2), NOT_REPRODUCED),
    ("S6", renamed("harmonic_balance", "figure_08", clearance=1.06), REPRODUCED),
    ("S6", renamed("harmonic_balance", "figure_08", clearance=1.07), NOT_REPRODUCED),
]


@pytest.mark.parametrize("number, change, verdict", BORDERS)
def test_verdict_changes_at_the_border(number, change, verdict):
    data = world()
    change(data)
    row = BY_NUMBER[number].judge(data)
    assert row["verdict"] == BY_NUMBER[number].words[verdict], row["evidence"]


@pytest.mark.parametrize(
    "printed, computed, right",
    [
        (2.0, 1.501, True),
        (2.0, 2.501, False),
        (2.8, 2.8499, True),
        (2.8, 2.8501, False),
        (2.37, 2.3651, True),
        (2.37, 2.3649, False),
        (0.69, 0.6949, True),
        (0.69, 0.6951, False),
    ],
)
def test_a_right_rounding_is_within_half_a_unit_of_the_last_digit(printed, computed, right):
    assert (misrounding(printed, computed) <= 1) == right


def test_the_width_that_agrees_least_counts():
    band = Band(1.8, 2.0, 0.05)
    assert largest_difference(0.2, band) == pytest.approx(1 / 3)
    assert largest_difference(0.15, band) == pytest.approx(1 / 4)
    assert largest_difference(0.16, Band(1.8, 2.0, 0.0)) == pytest.approx(0.2)
