"""What the rules share: a checked configuration, and the sources of a script."""

import ast
import gc
import json
import math
import os
import re
import shlex
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from snakemake.exceptions import WorkflowError

from impact_damper.workflow.configuration import (
    ConfigurationError,
    check_configuration,
    check_file,
    read_schemas,
    without_left_out,
)
from impact_damper.workflow.contradictions import SECTIONS
from impact_damper.data.variables.studies import AXES
from impact_damper.workflow.job_server import start as start_warm_process

# To plan makes many small objects that are all kept: to look for garbage among them takes a
# fifteenth of the time of a dry run.
gc.set_threshold(100_000)

ROOT = Path(workflow.basedir)
PACKAGE = Path(find_spec("impact_damper").origin).parent


wildcard_constraints:
    curve="[A-Za-z0-9_]+",
    oscillator="[A-Za-z0-9_]+",
    motion="[A-Za-z0-9_]+",
    optimum="[A-Za-z0-9_]+",
    run="[A-Za-z0-9_]+",
    grid="[A-Za-z0-9_]+",
    harmonics="[A-Za-z0-9_]+",
    passage="[A-Za-z0-9_]+",
    stepping="[A-Za-z0-9_]+",
    judged="[A-Za-z0-9_]+",
    figure="[A-Za-z0-9_]+",
    contact="[A-Za-z0-9_]+",
    limit="[A-Za-z0-9_]+",
    balance_map="[A-Za-z0-9_]+",
    scene="[A-Za-z0-9_]+",
    study="[A-Za-z0-9_]+",
    table="[a-z_]+",


def before_commands(words):
    """Have Snakemake put words before each command of a job.

    What stands there takes the place of Snakemake's own options for bash, and names in braces are
    filled in.
    """
    options = "set -euo pipefail; " if Path(shell.get_executable() or "").name == "bash" else ""
    shell.prefix(options + shlex.join(words).replace("{", "{{").replace("}", "}}"))


def checked(config):
    """The configuration with its keys in order, or an error that lists what is wrong with it."""
    config = without_left_out(config)
    schemas = read_schemas(ROOT / "workflow/schemas")
    try:
        for path in workflow.configfiles:
            check_file(path)
        check_configuration(config, schemas)
    except ConfigurationError as error:
        raise WorkflowError(f"The configuration cannot be run.\n{error}") from None
    # Snakemake compares parameters as text, in which the order of keys would count.
    return json.loads(json.dumps(config, sort_keys=True))


config = checked(config)


SHARED = workflow.workflow_settings.cache is not None


def untimed(path):
    """Leaves a rule as it is."""
    return lambda rule: rule


# Snakemake refuses to share what it times, for data that come from another workflow cost nothing
# here: with `--cache` the directive `benchmark` does nothing.
if SHARED:
    workflow.benchmark = untimed


@cache
def local(path):
    """Path as seen from the working directory, so that a checkout can move."""
    return os.path.relpath(path)


# An import from the package. To parse nothing else spares a dry run half a second.
IMPORT = re.compile(
    rf"^ *((?:from|import) {PACKAGE.name}\b(?:[^(\n]*\([^)]*\)|[^(\n]*$))", re.MULTILINE
)


@cache
def imports(path):
    """Modules of the package that a Python file imports itself.

    A package's `__init__` counts only where a name is taken from it: it runs in any
    case, but decides nothing.
    """
    statements = ast.parse("\n".join(IMPORT.findall(path.read_text()))).body
    names = []
    for node in statements:
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        else:
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    return {module_file(name) for name in names}


@cache
def module_file(name):
    """File of the module that `impact_damper.a.b` is, or that it is taken from."""
    path = PACKAGE.joinpath(*name.split(".")[1:])
    for place in (path, path.parent):
        for file in (place.with_suffix(".py"), place / "__init__.py"):
            if file.exists():
                return file
    raise WorkflowError(f"There is no module {name}.")


@cache
def code(script, *others):
    """What a job runs: inputs, so that their contents count.

    These are a script, other files and all modules they import, and the versions of all packages.
    """
    found, new = set(), {ROOT / "workflow/scripts" / script, *others}
    while new:
        found |= new
        new = set().union(*map(imports, new)) - found
    return sorted(map(local, found | {ROOT / "requirements.lock"}))


def write_provenance():
    """Write down what the results were made with; this alone may differ from run to run."""
    from impact_damper.workflow.provenance import provenance

    path = Path(config["results"]) / "provenance.json"
    part = path.with_name(f"{path.name}.part-{os.getpid()}")
    part.write_text(json.dumps(provenance(config, ROOT), indent=2) + "\n")
    os.replace(part, path)
