"""The registry of integrators: each implements the functions of the stages that compare it."""

import subprocess
import sys

import pytest

from impact_damper.rivals.methods import (
    COMPARED,
    LIMITED,
    METHODS,
    TOLERANCE_KEYS,
    integrators,
    name_and_mode,
    title_with_mode,
)
from impact_damper.rivals.runs import Integrator

ASKED = {
    "accuracy": "run",
    "missed_contacts": "flight",
    "stable_steps": "largest_displacements",
    "method_verdicts": "strobes",
}


def test_each_method_has_an_integrator_and_is_compared():
    assert list(integrators()) == list(METHODS)
    labels = {name_and_mode(label)[0] for each in COMPARED.values() for label in each}
    assert labels == set(METHODS)


@pytest.mark.parametrize("stage", ASKED)
def test_compared_integrators_implement_what_the_stage_calls(stage):
    assert set(ASKED) == set(COMPARED)
    for label in COMPARED[stage]:
        name, _ = name_and_mode(label)
        # The stage `missed_contacts` does not call `flight` of the Taylor series: it runs this
        # integrator with walls and checks whether a contact begins.
        if (stage, name) != ("missed_contacts", "taylor"):
            function = ASKED[stage]
            assert getattr(type(integrators()[name]), function) is not getattr(Integrator, function)


def test_methods_of_accuracy_have_tolerances():
    names = {name_and_mode(label)[0] for label in COMPARED["accuracy"]}
    for name in names:
        assert METHODS[name].tolerances in TOLERANCE_KEYS
        assert METHODS[name].slow == (name in LIMITED)


def test_labels_say_what_is_done_at_contacts():
    assert name_and_mode("merson") == name_and_mode("merson_kink") == ("merson", False)
    assert name_and_mode("DOP853_located") == ("DOP853", True)
    assert name_and_mode("taylor") == ("taylor", True)
    assert title_with_mode("merson") == "Merson, kink"
    assert title_with_mode("LSODA_located") == "LSODA, located"
    assert title_with_mode("heun") == "Heun"


def test_titles_are_read_without_numba():
    code = "import sys, impact_damper.rivals.methods; sys.exit('numba' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
