"""Each stage, table and kind of figure in the registry has its rule, script, functions and entries.

After its records are in the registry, this test names the files that a new stage still lacks.
"""

import ast
import re
from importlib import import_module, util

import pytest
from helpers import configurations
from helpers.running import ROOT

from chatterjee1995.workflow import selection
from chatterjee1995.workflow.models import ENTRIES
from chatterjee1995.workflow.registry import CHAPTERS, KINDS, STAGES, TABLES

CONFIG = configurations.read()
PACKAGE = "src/impact_damper"


def module_of(name, path):
    """Return the module with a path such as "tables.contact", which must exist, and its file."""
    file = f"{PACKAGE}/{path.replace('.', '/')}.py"
    assert util.find_spec(f"impact_damper.{path}"), f"{file}: {name} needs this module"
    return import_module(f"impact_damper.{path}"), file


@pytest.mark.parametrize("name", STAGES)
def test_a_stage_has_a_rule_a_script_and_a_section(name):
    (chapter,) = [key for key, each in CHAPTERS.items() if STAGES[name] in each.STAGES]
    rules = ROOT / f"workflow/rules/{chapter}.smk"
    script = ROOT / f"workflow/scripts/{name}.py"
    assert f"rule {name}:\n" in rules.read_text(), f"workflow/rules/{rules.name}: no rule {name}"
    assert script.exists(), f"workflow/scripts/{name}.py: {name} needs this script"
    section = STAGES[name].section
    assert section in ENTRIES, f"{PACKAGE}/workflow/models/: no SECTIONS has {section}"
    entries = section in CONFIG and list(selection.entries(CONFIG, name))
    assert entries, f"config/config.yaml: no entry of {section}"


@pytest.mark.parametrize("name", STAGES)
def test_a_script_imports_what_exists(name):
    for node in ast.walk(ast.parse((ROOT / f"workflow/scripts/{name}.py").read_text())):
        if isinstance(node, ast.ImportFrom) and node.module.startswith("impact_damper."):
            file = f"src/{node.module.replace('.', '/')}.py"
            assert util.find_spec(node.module), f"{file}: the script {name} needs this module"
            for alias in node.names:
                known = hasattr(import_module(node.module), alias.name)
                assert known, f"{file}: the script {name} needs {alias.name}"


@pytest.mark.parametrize("name", TABLES)
def test_a_table_has_a_function_and_columns(name):
    module, file = module_of(name, TABLES[name].module)
    assert hasattr(module, name), f"{file}: no function {name}"
    columns = hasattr(module, "document") or name in module.SHOWN
    assert columns, f"{file}: SHOWN lacks {name}"


@pytest.mark.parametrize("name", KINDS)
def test_a_kind_of_figure_has_a_function_a_caption_and_an_entry(name):
    module, file = module_of(name, KINDS[name].source)
    assert hasattr(module, "CAPTION"), f"{file}: no CAPTION"
    if KINDS[name].stages:
        assert hasattr(module, f"draw_{name}"), f"{file}: no function draw_{name}"
    drawn = {figure["kind"] for figure in CONFIG["figures"].values()}
    assert name in drawn, f"config/config.yaml: no entry of figures has the kind {name}"


@pytest.mark.parametrize("name", sorted({*STAGES, *TABLES}))
def test_tests_name_each_stage_and_table(name):
    texts = (path.read_text() for path in (ROOT / "tests").rglob("test_*.py"))
    named = any(re.search(rf"\b{name}\b", text) for text in texts)
    assert named, f"tests/stages/test_{name}.py: no test names {name}"
