"""The import of the package changes no setting of numba; kernels have their own cache folder."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import impact_damper
from impact_damper.kernel.compiling import MESSAGE

PACKAGE = Path(impact_damper.__file__).parent

FOREIGN = """
import numba

@numba.njit(cache=True)
def double(x):
    return 2.0 * x
"""

USER = """
import sys
import numba
before = numba.config.CACHE_DIR, numba.config.CPU_FEATURES, numba.config.CPU_NAME
import impact_damper
impact_damper.simulate
import foreign
assert foreign.double(2.0) == 4.0
assert before == (numba.config.CACHE_DIR, numba.config.CPU_FEATURES, numba.config.CPU_NAME)
# Kernels are bound, and therefore compiled, when their modules are imported.
loaded = {name for name in sys.modules if name.startswith("impact_damper.kernel.")}
assert "impact_damper.kernel.single" in loaded
assert loaded.isdisjoint({"impact_damper.kernel.tangents", "impact_damper.kernel.batch"})
assert "plot" in dir(impact_damper) and "matplotlib" not in sys.modules
"""

SLOW = """
import time
from numba.core import event
import impact_damper.kernel.compiling

class dispatcher:
    def py_func():
        pass

for module, seconds in COMPILED:
    dispatcher.py_func.__module__ = module
    with event.trigger_event("numba:compile", data={"dispatcher": dispatcher}):
        time.sleep(seconds)
"""


def run(code, *, without=(), **environment):
    """Run code in a fresh Python, and return what it writes to standard error."""
    environment = os.environ | environment
    process = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=300,
        env={name: value for name, value in environment.items() if name not in without},
    )
    assert process.returncode == 0, process.stderr
    return process.stderr


def test_an_import_leaves_numba_as_it_was_and_binds_no_unused_kernels(tmp_path):
    (tmp_path / "foreign.py").write_text(FOREIGN)
    paths = os.pathsep.join([str(tmp_path), *sys.path])
    run(USER, without=("NUMBA_CACHE_DIR",), PYTHONPATH=paths)
    assert list((tmp_path / "__pycache__").glob("foreign.double-*.nbi"))


@pytest.mark.parametrize(
    ("compiled", "written"),
    [
        ([("impact_damper.made_up", seconds) for seconds in (0.7, 0.7, 1.1)], f"{MESSAGE}\n"),
        ([("impact_damper.made_up", 0.1), ("foreign", 1.1)], ""),
    ],
)
def test_compiling_says_so_once_when_it_takes_longer_than_a_second(compiled, written):
    code = SLOW.replace("COMPILED", repr(compiled))
    assert run(code, PYTHONPATH=os.pathsep.join(sys.path)) == written


def digest(folder, module):
    """Return what `kernel_digest` returns for a module, in a copy of the package."""
    code = (
        "from impact_damper.kernel.sources import kernel_digest, module_file; "
        f"print(kernel_digest(module_file({module!r})))"
    )
    environment = os.environ | {"PYTHONPATH": str(folder)}
    return subprocess.check_output([sys.executable, "-c", code], env=environment)


@pytest.mark.parametrize(
    ("edited", "changes"),
    [
        ("kernel/equation.py", True),
        ("kernel/templates/step.py", True),
        ("motions/records.py", True),
        ("motions/sweep.py", False),
        ("__init__.py", False),
    ],
)
def test_an_edit_compiles_only_the_kernels_that_depend_on_it(tmp_path, edited, changes):
    shutil.copytree(PACKAGE, tmp_path / "impact_damper")
    before = digest(tmp_path, "impact_damper.motions.watch")
    with (tmp_path / "impact_damper" / edited).open("a") as file:
        file.write("# edited\n")
    assert (digest(tmp_path, "impact_damper.motions.watch") != before) == changes
