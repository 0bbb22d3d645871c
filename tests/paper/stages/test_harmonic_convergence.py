"""Convergence of harmonic balance with the number of harmonics: rates by theory, and failures."""

import numpy as np
import pytest
from helpers.known_orbits import PAPER
from scipy.special import ellipk

from chatterjee1995.figures.balance import draw_harmonic_convergence
from chatterjee1995.stages import harmonic_convergence
from chatterjee1995.tables.balance import harmonic_convergence as table
from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator

SOFT = Damper(0.12, 2.0, contact_stiffness=200.0)


@pytest.fixture(scope="module")
def soft():
    chosen = harmonic_convergence.ladder(321)
    return harmonic_convergence.harmonic_convergence(PAPER, SOFT, 2.0, chosen, cold=[1, 3, 31])


@pytest.fixture(scope="module")
def free():
    chosen = harmonic_convergence.ladder(21)
    return harmonic_convergence.harmonic_convergence(PAPER, None, 1.9, chosen, cold=chosen.tolist())


@pytest.mark.thorough
def test_elastic_contact_converges_by_the_predicted_powers(soft):
    assert (soft["series_status"] == flag("series_status", "converged")).all()
    assert (soft["hill_status"] == flag("hill_status", "found")).all()
    away = soft["decay_observed"] - soft["decay_predicted"]
    assert np.abs(away.sel(error_measure=["retained", "omitted"])).max() < 0.2
    # The errors "maximum" and "multiplier" oscillate as N grows, so their fit is less accurate.
    assert np.abs(away).max() < 0.8


def test_free_motion_converges_at_the_rate_of_its_singularity(free):
    """Integration in complex time predicts the rate. The errors come from Fourier series."""
    at = free.sel(error_measure="omitted")
    assert at["decay_observed"].item() == pytest.approx(at["decay_predicted"].item(), rel=1e-3)
    assert free["series_error"].sel(error_measure="maximum")[-1] < 1e-13


def test_singularity_of_a_fast_motion():
    """Z'' + Z^3 = 0 has the solution A cn(A T). Its poles are K(1/2)/A = 1.8541/A off real T."""
    amplitude = 10.0
    p = pack(Oscillator(1e-9), None, 5.0)
    near = harmonic_convergence.singularity_distance(p, np.array([amplitude, 0, amplitude, 0]))
    # The tolerance allows for the forcing, which is a thousandth of the spring's force.
    assert near == pytest.approx(ellipk(0.5) / amplitude, rel=1e-3)


@pytest.mark.thorough
def test_cold_starts_are_told_apart(soft):
    status = dict(zip(soft["highest_harmonic"].values, soft["cold_status"].values, strict=True))
    assert status[1] == status[3] == flag("cold_status", "same_motion")
    assert status[31] > flag("cold_status", "same_motion")
    assert status[5] == flag("cold_status", "not_tried")


@pytest.mark.thorough
def test_table_and_figure(soft, free):
    rows = table({"harmonic_convergence": {"soft": soft, "free": free}}).set_index("motion")
    assert rows.loc["soft", "harmonics for an error of 1 %"] == 23
    assert (
        rows.loc["free", "cold starts"] == rows.loc["free", "cold starts that find the motion"] == 9
    )
    assert np.isnan(rows.loc["free", "mass ratio rm"])
    drawn = draw_harmonic_convergence(harmonic_convergence=[soft, free])
    assert len(drawn.axes) == 4


def test_failures_are_stored():
    """With very stiff walls Newton's method for 63 harmonics fails from a single harmonic."""
    stiff = Damper(0.12, 2.0, contact_stiffness=1e8)
    data = harmonic_convergence.harmonic_convergence(PAPER, stiff, 2.0, [63])
    assert data["series_status"][0] != flag("series_status", "converged")
    assert data["hill_status"][0] == flag("hill_status", "not_tried")
    assert np.isnan(data["exact_maximum"])
    assert np.isnan(data["series_error"]).all() and np.isnan(data["decay_observed"]).all()
    assert table({"harmonic_convergence": {"stiff": data}})["failed"].item() == 1
    draw_harmonic_convergence(harmonic_convergence=[data]).draw_without_rendering()


def test_no_solution_to_begin_from():
    with pytest.raises(ArithmeticError, match="no solution with contacts"):
        harmonic_convergence.harmonic_convergence(PAPER, Damper(0.12, 500.0), 2.0, [1])
