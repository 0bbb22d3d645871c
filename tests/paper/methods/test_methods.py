"""The registry of integrators: each implements the functions of the stages that compare it."""

import subprocess
import sys

import pytest
from helpers import configurations

from chatterjee1995.methods.methods import (
    COMPARED,
    METHODS,
    integrators,
    name_and_mode,
    title_with_mode,
)
from chatterjee1995.methods.runs import Integrator

FILE = "rivals/methods.py"
CONFIG = configurations.read()["comparison"]
ASKED = {
    "accuracy": "run",
    "missed_contacts": "flight",
    "stable_steps": "largest_displacements",
    "method_verdicts": "strobes",
}


def test_each_method_has_an_integrator_and_is_compared():
    made = list(integrators())
    assert made == list(METHODS), f"{FILE}: integrators() makes {made}, not {list(METHODS)}"
    compared = {name_and_mode(label)[0] for each in COMPARED.values() for label in each}
    unknown, idle = compared - set(METHODS), set(METHODS) - compared
    assert not unknown, f"{FILE}: COMPARED has {unknown}, which METHODS lacks"
    assert not idle, f"{FILE}: no stage in COMPARED has {idle}"


@pytest.mark.parametrize("stage", ASKED)
def test_compared_integrators_implement_what_the_stage_calls(stage):
    assert set(ASKED) == set(COMPARED)
    for label in COMPARED[stage]:
        name, _ = name_and_mode(label)
        # The stage `missed_contacts` does not call `flight` of the Taylor series: it runs this
        # integrator with walls and checks whether a contact begins.
        if (stage, name) != ("missed_contacts", "taylor"):
            function, kind = ASKED[stage], type(integrators()[name])
            own = getattr(kind, function) is not getattr(Integrator, function)
            assert own, f"{kind.__module__}: {stage} calls {function}, which {name} lacks"


def test_methods_of_accuracy_have_tolerances():
    names = {name_and_mode(label)[0] for label in COMPARED["accuracy"]}
    for name in names:
        method = METHODS[name]
        assert method.tolerances, f"{FILE}: accuracy compares {name}, which has no tolerances"
        known = method.tolerances in CONFIG
        assert known, f"config/config.yaml: comparison has no tolerances {method.tolerances}"
        if method.slow:
            limited = name in CONFIG["evaluations"]
            assert limited, f"config/config.yaml: comparison.evaluations lacks {name}"


def test_labels_say_what_is_done_at_contacts():
    assert name_and_mode("merson") == name_and_mode("merson_kink") == ("merson", False)
    assert name_and_mode("DOP853_located") == ("DOP853", True)
    assert name_and_mode("taylor") == ("taylor", True)
    assert title_with_mode("merson") == "Merson, kink"
    assert title_with_mode("LSODA_located") == "LSODA, located"
    assert title_with_mode("heun") == "Heun"


def test_titles_are_read_without_numba():
    code = "import sys, chatterjee1995.methods.methods; sys.exit('numba' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
