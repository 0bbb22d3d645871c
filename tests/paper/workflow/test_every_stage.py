"""For each record in `sections` these tests name the function, entry and test that are missing."""

import inspect
import re
from importlib import import_module, util

import pytest
from helpers import configurations
from helpers.running import ROOT

from chatterjee1995.sections import selection
from chatterjee1995.sections.registry import KINDS, STAGES, TABLES

CONFIG = configurations.paper()


def found(name, user):
    """Return the object with a name such as "module:function", and the file of the module."""
    module, function = name.split(":")
    file = f"src/{module.replace('.', '/')}.py"
    assert util.find_spec(module), f"{file}: {user} needs this module"
    assert hasattr(import_module(module), function), f"{file}: {user} needs {function}"
    return getattr(import_module(module), function), file


@pytest.mark.parametrize("name", sorted(STAGES))
def test_a_stage_has_a_function_that_takes_its_parameters(name):
    stage = STAGES[name]
    function, file = found(stage.function, name)
    entries = selection.entries(CONFIG, name)
    assert entries, f"config/config.yaml: no entry of {stage.section}"
    signature = inspect.signature(function)
    offered = {"name", "folder", "progress", "workers"} & set(signature.parameters)
    for entry in entries:
        if name == "studies":
            given = getattr(CONFIG, stage.section)[entry].chunk(CONFIG, "1-of-1")
        else:
            given = selection.job(CONFIG, name, entry)
        system = [given.pop("system")] if "system" in given else []
        keys = given.keys() | stage.reads.keys() | stage.files.keys() | offered
        try:
            signature.bind(*system, **dict.fromkeys(keys))
        except TypeError as error:
            raise AssertionError(f"{file}: {function.__name__}{signature}: {error}") from None


@pytest.mark.parametrize("name", sorted(TABLES))
def test_a_table_has_a_function(name):
    table = TABLES[name]
    found(f"{table.source}:{name}", f"the table {name}")
    assert set(table.stages) <= STAGES.keys()


@pytest.mark.parametrize("name", sorted(KINDS))
def test_a_kind_of_figure_has_a_function_and_an_entry(name):
    kind = KINDS[name]
    drawn = [figure for figure in CONFIG.figures.values() if figure.kind == name]
    assert drawn, f"config/config.yaml: no entry of figures has the kind {name}"
    functions = [f"draw_{name}"] if kind.stages else [each.data[0] for each in drawn]
    for function in functions:
        found(f"{kind.source}:{function}", f"the kind {name}")


@pytest.mark.parametrize("name", sorted({*STAGES, *TABLES}))
def test_tests_name_each_stage_and_table(name):
    texts = (path.read_text() for path in (ROOT / "tests").rglob("test_*.py"))
    named = any(re.search(rf"\b(draw_)?{name}\b", text) for text in texts)
    assert named, f"tests/paper/stages/test_{name}.py: no test names {name}"
