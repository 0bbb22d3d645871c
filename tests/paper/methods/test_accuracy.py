"""Errors and work of methods on scenes (test cases), and the tolerance of production runs."""

import json
from pathlib import Path

import numpy as np
import pytest
from helpers import configurations

from chatterjee1995.methods import accuracy, averages
from chatterjee1995.methods.integrators import integrators, runs_of_accuracy
from chatterjee1995.methods.integrators.taylor import taylor
from chatterjee1995.methods.labels import MODELS, TOLERANCE_KEYS, method_in_words
from chatterjee1995.tables.methods import cheapest, models
from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper, Oscillator, pick
from impact_damper.motions.strobe_map import strobe_time

ROOT = Path(__file__).resolve().parents[3]
CONFIG = configurations.read()
REFERENCES = json.loads((ROOT / "workflow/resources/references.json").read_text())
FEW = {
    **dict.fromkeys(TOLERANCE_KEYS, [1e-6]),
    "taylor": [1e-3, 1e-6, 1e-9],
    "orders": [[10, 13]],
    "merson": [1e-5, 1e-7],
    "evaluations": 2000,
    "harmonics": 15,
    "batch": 10,
    "scipy_periods": 20,
}


def system_of(name):
    """Return oscillator and damper of a scene of the configuration."""
    given = CONFIG["scenes"][name]
    damper = Damper(**pick(Damper, CONFIG | given)) if "mass_ratio" in given else None
    return Oscillator(**pick(Oscillator, CONFIG["oscillators"][given["oscillator"]])), damper


def rest_of(name):
    """Return the other attributes of a scene."""
    keys = ("frequency", "state", "periods", "motion", "accuracy")
    return {key: CONFIG["scenes"][name][key] for key in keys}


def errors_of(name, settings, **changes):
    given = rest_of(name) | changes
    return accuracy.accuracy(
        *system_of(name), name=name, settings=settings, references=REFERENCES, **given
    )


def of(data, method):
    return data.isel(run=np.flatnonzero(data["method"].values == method))


@pytest.fixture(scope="module")
def inelastic():
    return errors_of("inelastic", FEW)


def test_the_taylor_series_agrees_with_the_80_bit_reference(inelastic):
    found = of(inelastic, "taylor")
    assert (found["run_status"] == flag("run_status", "ok")).all()
    assert (found["state_error"].values < 1e-2 * np.array(FEW["taylor"])).all()
    assert (np.diff(found["operations"]) > 0).all()
    other = of(inelastic, "taylor_10_13")
    assert (other["state_error"].values < 0.1 * np.array(FEW["taylor"])).all()
    # A lower order needs fewer operations at a loose tolerance, and more at a tight tolerance.
    dearer = other["operations"].values > found["operations"].values
    assert list(dearer) == sorted(dearer) and dearer[-1]


def test_models_of_the_orbit_have_errors_in_the_expected_order(inelastic):
    errors = {
        name: float(of(inelastic, name)["amplitude_error"][-1])
        for name in ("many_harmonics", "rigid", "rigid_mended", "shooting")
    }
    assert errors["shooting"] < 1e-8 < errors["rigid_mended"] < errors["rigid"]
    assert errors["rigid"] < errors["many_harmonics"]
    status = of(inelastic, "full_balance")["run_status"]
    assert (status == flag("run_status", "not_applicable")).all()


def test_contacts_near_grazing_are_missed_by_methods_that_check_the_ends_of_steps():
    few = FEW | {"taylor": [1e-8], "merson": [1e-7]}
    data = errors_of("grazing", few)
    assert of(data, "taylor")["run_status"][0] == flag("run_status", "ok")
    for name in ("merson_located", "DOP853_located"):
        assert of(data, name)["run_status"][0] == flag("run_status", "missed_contacts")


def typical_averages(given, integrate, periods, exponents=False):
    """Return medians over five starts, since in a run the loose mass may rest for a long time."""
    begin, found = strobe_time(given.p), []
    for shift in 1e-3 * np.arange(5):
        start = np.array(given.state) + shift
        run = integrate(given.p, start, begin, periods)
        batches = averages.of_run(given.p, run, begin, periods, 20)
        if exponents:
            batches["exponent"] = averages.exponents(given.p, start, 1e-9, periods, 20)
        found.append(averages.estimates(batches))
    return np.median(found, axis=0)


def test_averages_agree_between_methods_and_have_errors_that_fall():
    given = accuracy.ComparisonScene(*system_of("chaos"), **rest_of("chaos"))
    short, long = (
        typical_averages(given, lambda *problem: taylor(*problem, 1e-9), periods, True)
        for periods in (400, 1600)
    )
    assert (np.abs(short[0] - long[0]) < 4 * np.hypot(short[1], long[1])).all()
    assert (long[1] < short[1]).all()
    merson = integrators()["merson"]
    other = typical_averages(given, lambda *problem: merson.run(*problem, 1e-6, True), 400)
    away = np.abs(other[0] - short[0]) / np.hypot(other[1], short[1])
    assert (away[:2] < 4).all()
    assert np.isnan(away[2])


def test_stages_use_the_cheapest_tolerance_that_meets_what_a_scene_asks():
    """With this tolerance, and with all smaller tolerances, the series is accurate enough."""
    alone = {"taylor": CONFIG["comparison"]["taylor"]} | dict.fromkeys(("orders", "merson"), [])
    data = errors_of("many_contacts", FEW | alone | {"scipy": []})
    series = of(data, "taylor").sortby("setting")
    meets = series["meets_accuracy"].values == flag("meets_accuracy", "yes")
    assert series["setting"][np.argmin(meets) - 1] == CONFIG["settling"]["tolerance"]
    chosen = data.isel(run=cheapest(data, ("taylor",)))
    assert float(chosen["setting"]) == CONFIG["settling"]["tolerance"]


def test_a_reference_of_another_scene_is_refused():
    with pytest.raises(ValueError, match="compute it again"):
        errors_of("design", FEW, periods=10)


def test_the_table_marks_the_cheapest(inelastic):
    words = {method_in_words(label) for label in [*runs_of_accuracy(), *MODELS]}
    table = models({"accuracy": {"inelastic": inelastic}})
    chosen = table[table.choice == "cheapest that is accurate enough"]
    meets = table[(table["meets the required accuracy"] == "yes") & table.method.isin(words)]
    assert len(chosen) == 1
    work = "work [floating-point operations]"
    assert chosen[work].iloc[0] == meets[work].min()
    assert set(table.method) <= {*words, "Taylor, orders 10 and 13"}
