"""Errors and counted work of methods on scenes (test cases), and the tolerance that stages use.

The counted work is the number of floating-point operations.

Z1 is the displacement of the primary mass. A stage is a step of the workflow.
"""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from helpers import configurations

from chatterjee1995.methods import accuracy, averages, orbit_models, runs, taylor_runs
from chatterjee1995.methods.comparison_scenes import ComparisonScene
from chatterjee1995.methods.methods import LIMITED, TOLERANCE_KEYS, integrators
from chatterjee1995.methods.operations import ELEMENTARY, operations
from chatterjee1995.tables.accuracy import LABELS, SHOWN, cheapest, models
from impact_damper.data.datasets import flag
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions import traces
from impact_damper.motions.strobe_map import strobe_time

ROOT = Path(__file__).resolve().parents[3]
CONFIG = configurations.read()
REFERENCES = json.loads((ROOT / "workflow/resources/references.json").read_text())
FEW = {
    **dict.fromkeys(TOLERANCE_KEYS, [1e-6]),
    "taylor": [1e-3, 1e-6, 1e-9],
    "orders": [[10, 13]],
    "merson": [1e-5, 1e-7],
    "evaluations": dict.fromkeys(LIMITED, 2000) | {"Radau": 300},
    "harmonics": 15,
    "batch": 10,
    "scipy_periods": 20,
}


def scene(name, **changes):
    given = CONFIG["scenes"][name]
    free = CONFIG["oscillators"][given["oscillator"]]
    damper = None
    if "mass_ratio" in given:
        parts = (given[key] for key in ("mass_ratio", "clearance", "restitution"))
        damper = Damper(*parts, CONFIG["contact_stiffness"])
    keys = ("frequency", "state", "periods", "motion", "accuracy")
    rest = {key: given[key] for key in keys} | {"tolerance": given.get("tolerance")} | changes
    oscillator = Oscillator(free["damping"], free["linear_frequency"])
    return ComparisonScene(name, oscillator, damper, **rest)


def of(data, method):
    return data.isel(run=np.flatnonzero(data["method"].values == method))


@pytest.fixture(scope="module")
def inelastic():
    return accuracy.error_against_work(scene("inelastic"), FEW, REFERENCES["inelastic"])


def straight(a, b):
    x = a * b + math.sqrt(a)
    return x / b - a


def with_loops(values, order):
    total = 0.0
    for k in range(order):
        total += values[k - 1] * values[k + 1]
    while total < 1.0:
        total = total * 2.0 + math.exp(total)
    return math.cos(total) if order > 3 else total


def of_pairs(a, b):
    pair = a * (b, a - b)
    for _ in range(3):
        pair = -pair + (a, 0.0)
    first, second = pair - a
    pair = first * second
    return pair * a


compiled = kernel(straight)


def calling(a):
    return compiled(a + 1.0, a)


def test_operations_are_counted_as_by_hand():
    assert operations(straight) == 5
    # `calling` adds a sum to the operations of the function that it calls.
    assert operations(calling) == 1 + operations(compiled)
    assert operations(calling, without=(compiled,)) == 1
    # `of_pairs`: a product of a number and a pair, a difference in the pair, three sums and a
    # difference of pairs, and two products of numbers.
    assert operations(of_pairs) == 2 + 1 + 3 * 2 + 2 + 1 + 1
    # `with_loops`: ten rounds of a product and a sum; three of a product, a sum and an exponential;
    # a cosine.
    assert operations(with_loops, 3, order=10) == 10 * 2 + 3 * (2 + ELEMENTARY) + ELEMENTARY


def test_a_loop_of_unknown_length_is_told():
    with pytest.raises(ValueError, match="length is not known"):
        operations(with_loops)


@pytest.mark.parametrize("kind", [taylor_runs.FLIGHT, taylor_runs.MEETING, taylor_runs.CONTACT])
def test_a_step_costs_what_the_recurrence_does(kind):
    # With the order N of the Taylor series, the product Z1 times Z1^2 takes about N^2/2 products
    # and the square Z1^2, by symmetry, N^2/8, each with as many sums. All other terms, and the
    # search for the contact, grow linearly with N.
    order = CONTACT_ORDER if kind == taylor_runs.CONTACT else FLIGHT_ORDER
    assert 1.0 < taylor_runs.step_work(kind) / (1.25 * order**2 + 20 * order) < 2.0
    assert taylor_runs.step_work(kind, 1) > taylor_runs.step_work(kind)


def test_a_contact_that_is_expected_costs_its_step_more():
    assert taylor_runs.step_work(taylor_runs.MEETING) > taylor_runs.step_work(taylor_runs.FLIGHT)
    given = scene("design")
    begin = strobe_time(given.p)
    rows, _ = taylor_runs.all_steps(given.p, np.array(given.state), begin, 3, 1e-9)
    counts = taylor_runs.counted(rows)
    assert counts[taylor_runs.MEETING] == counts[taylor_runs.CONTACT] == 6


def test_contacts_and_peaks_from_samples_agree_with_those_of_the_series():
    for name in ("resonance", "design"):
        given = scene(name)
        begin, period = strobe_time(given.p), 2 * math.pi / given.frequency
        run = taylor_runs.taylor(given.p, np.array(given.state), begin, 2, 1e-13)
        times = begin + period * np.arange(801) / 400
        states = np.empty((801, 4))
        start = np.array(given.state)
        traces.trace(given.p, start, begin, times, 1e-13, states, np.empty((0, 5)))
        read = runs.read_off(given.p, 0.0, times, states)
        assert len(read.contact_times) == len(run.contact_times)
        assert np.allclose(read.contact_times, run.contact_times, atol=1e-4)
        assert read.displacement == pytest.approx(run.displacement, rel=1e-7)


def test_the_taylor_series_agrees_with_the_80_bit_reference(inelastic):
    found = of(inelastic, "taylor")
    assert (found["run_status"] == flag("run_status", "ok")).all()
    assert (found["state_error"].values < 1e-2 * np.array(FEW["taylor"])).all()
    assert (np.diff(found["operations"]) > 0).all()
    other = of(inelastic, "taylor_10_13")
    assert (other["state_error"].values < 0.1 * np.array(FEW["taylor"])).all()
    # A lower order needs fewer operations at a loose tolerance and more at a tight one.
    dearer = other["operations"].values > found["operations"].values
    assert list(dearer) == sorted(dearer) and dearer[-1]


def test_errors_of_merson_fall_with_its_order(inelastic):
    found = of(inelastic, "merson_located")
    assert found["state_error"][1] < 0.1 * found["state_error"][0]
    assert found["operations"][1] > found["operations"][0]


def test_models_of_the_orbit_have_errors_in_the_expected_order(inelastic):
    errors = {
        name: float(of(inelastic, name)["amplitude_error"][-1])
        for name in ("many_harmonics", "rigid", "rigid_mended", "shooting")
    }
    assert errors["shooting"] < 1e-8 < errors["rigid_mended"] < errors["rigid"]
    assert errors["rigid"] < errors["many_harmonics"]
    assert (
        of(inelastic, "full_balance")["run_status"] == flag("run_status", "not_applicable")
    ).all()


def test_an_elastic_balance_solves_its_own_equations():
    given = scene("design")
    parts = given.oscillator, given.damper, given.frequency
    model = orbit_models.full_balance(*parts, np.array(given.state))
    many = orbit_models.many_harmonics(*parts, np.array(given.state), 3)
    assert model.status == many[3].status == "ended"
    assert len(model.contact_phases) == 2
    assert many[3].operations > model.operations


def test_contacts_near_grazing_are_missed_by_methods_that_check_the_ends_of_steps():
    few = FEW | {"taylor": [1e-8], "merson": [1e-7]}
    data = accuracy.error_against_work(scene("grazing"), few, REFERENCES["grazing"])
    status = {
        name: int(of(data, name)["run_status"][0])
        for name in ("taylor", "merson_located", "DOP853_located")
    }
    assert status["taylor"] == flag("run_status", "ok")
    assert status["merson_located"] == flag("run_status", "missed_contacts")
    assert status["DOP853_located"] == flag("run_status", "missed_contacts")


def typical_averages(given, integrate, periods, exponents=False):
    """Medians over five starts of the averages and their standard errors.

    A single run may not be typical: the loose mass may be almost at rest for hundreds of cycles.
    """
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
    given = scene("chaos")
    short, long = (
        typical_averages(given, lambda *problem: taylor_runs.taylor(*problem, 1e-9), periods, True)
        for periods in (400, 1600)
    )
    assert (np.abs(short[0] - long[0]) < 4 * np.hypot(short[1], long[1])).all()
    assert (long[1] < short[1]).all()
    merson = integrators()["merson"]
    other = typical_averages(given, lambda *problem: merson.run(*problem, 1e-6, True), 400)
    away = np.abs(other[0] - short[0]) / np.hypot(other[1], short[1])
    assert (away[:2] < 4).all()
    assert np.isnan(away[2])


def loosest_tolerance(data):
    """Return the largest tolerance such that the Taylor series is accurate with it and below it.

    Accurate means that the error is within the accuracy that the scene requires.
    """
    of = data["method"].values == "taylor"
    tolerances = data["setting"].values[of]
    meets = data["meets_accuracy"].values[of] == flag("meets_accuracy", "yes")
    order = np.argsort(tolerances)
    held = np.cumprod(meets[order]).astype(bool)
    return float(tolerances[order][held].max())


def test_stages_use_the_cheapest_tolerance_that_meets_what_a_scene_asks():
    name = "many_contacts"
    settings = CONFIG["comparison"] | {"merson": [], "scipy": []}
    data = accuracy.error_against_work(scene(name), settings, REFERENCES[name])
    assert loosest_tolerance(data) == CONFIG["settling"]["tolerance"]
    chosen = data.isel(run=cheapest(data, ("taylor",)))
    assert float(chosen["setting"]) == CONFIG["settling"]["tolerance"]


def test_a_reference_of_another_scene_is_refused():
    with pytest.raises(ValueError, match="compute it again"):
        accuracy.error_against_work(scene("design", periods=10), FEW, REFERENCES["design"])
    with pytest.raises(ValueError, match="needs its reference"):
        accuracy.error_against_work(scene("design"), FEW)


def test_an_accuracy_that_a_motion_does_not_have_is_refused():
    with pytest.raises(ValueError, match="for a chaotic motion"):
        accuracy.error_against_work(
            scene("chaos", accuracy={"quantity": "state", "within": 0.1}), FEW
        )


def test_the_table_marks_the_cheapest(inelastic):
    table = models({"accuracy": {"inelastic": inelastic}})
    # The column of averages exists for chaotic scenes only.
    assert SHOWN["models"].keys() - {"contacts a period"} <= set(table)
    chosen = table[table.choice == "cheapest that is accurate enough"]
    meets = table[(table["meets it"] == "yes") & table.method.isin(LABELS)]
    assert len(chosen) == 1
    assert chosen.operations.iloc[0] == meets.operations.min()
    assert set(table.method) <= {*LABELS, "taylor_10_13"}
