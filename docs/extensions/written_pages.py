"""Pages generated from the code and from a finished run, before Sphinx reads the other pages.

The claims and the figures come from `results/` or, if it does not exist, from the reduced run in
`results-smoke/`. If neither exists, the pages say which command makes the run.
"""

import os
import pkgutil
import re
import shutil
from importlib import import_module
from pathlib import Path

import pandas as pd
from typer.testing import CliRunner

import chatterjee1995
from chatterjee1995.claims.verdicts import document
from chatterjee1995.sections.reference import reference
from impact_damper.command.command_line import app as command
from impact_damper.data.variables import VARIABLES

ROOT = Path(__file__).parents[2]
# Folders of results in the order of preference, and their names on the pages.
RUNS = {
    "results": "the full run",
    "results-smoke": "the reduced run, which cannot decide most claims",
}
MISSING = "No run was found. Run `make reproduce`, then `make docs`.\n"


def write_pages(app):
    """Write all pages into `docs/written/`."""
    folder = Path(app.srcdir) / "written"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    run = next((name for name in RUNS if (ROOT / name / "tables/claims.csv").exists()), None)
    pages = {
        "variables": variables(),
        "configuration": reference(),
        "commands": commands(),
        "claims": claims(run, folder) if run else f"# The paper, claim by claim\n\n{MISSING}",
        "figures": figures(run, folder) if run else f"# All figures\n\n{MISSING}",
    }
    for name, text in pages.items():
        (folder / f"{name}.md").write_text(text)


def variables():
    """Return the page that lists all variables of datasets; the paper's modules register theirs."""
    for module in pkgutil.walk_packages(chatterjee1995.__path__, "chatterjee1995."):
        import_module(module.name)
    parts = [
        "# Variables of the datasets\n",
        "In datasets of a machine the attribute `units` holds the unit of a variable. A variable "
        "with named values stores numbers, and `idm.decode` returns the names.\n",
    ]
    parts.append("| name | meaning | symbol | values |\n|---|---|---|---|")
    for name, each in sorted(VARIABLES.items()):
        values = ", ".join(f"{word} {number}" for word, number in (each.flags or {}).items())
        values = values or ("" if each.units == "1" else each.units)
        cells = (f"`{name}`", each.long_name, each.symbol, values)
        parts.append(f"| {' | '.join(cell.replace('|', 'abs ') for cell in cells)} |")
    return "\n".join([*parts, ""])


def commands():
    """Return the page of the command line, with the help of each command."""
    parts = [
        "# The command `impact-damper`\n",
        "A file describes the machine; [](../howto/machine_file.md) shows an example. If a value "
        "is wrong, the command stops and names the key and the values allowed.\n",
    ]
    os.environ["TERM"] = "dumb"
    for name in ("", *sorted(each.callback.__name__ for each in command.registered_commands)):
        asked = [name, "--help"] if name else ["--help"]
        told = CliRunner().invoke(command, asked, prog_name="impact-damper").stdout
        parts.append(f"## impact-damper {name}".rstrip() + "\n")
        parts.append(f"```text\n{told.strip()}\n```\n")
    return "\n".join(parts)


def claims(run, folder):
    """Return the page of the claims, with figures of the run."""
    table = pd.read_csv(ROOT / run / "tables/claims.csv", dtype=str, keep_default_na=False)
    title, *parts = document(table, lambda name: picture(run, name, folder)).split("\n\n")
    return "\n\n".join([title, f"From {RUNS[run]}.", *parts])


def figures(run, folder):
    """Return the page of all figures of a run with their captions, sorted by name."""
    common = (ROOT / "workflow/report/workflow.rst").read_text().split("\n\n")[-1]
    parts = [f"# All figures\n\nFrom {RUNS[run]}.\n", common]
    for path in sorted((ROOT / run / "figures").glob("*.rst")):
        title, _, caption = path.read_text().partition(":")
        parts += [f"## {path.stem.replace('_', ' ')}\n", picture(run, path.stem, folder)]
        parts.append(f"{title}: {' '.join(caption.split())}\n")
    return "\n".join(parts)


def picture(run, name, folder):
    """Copy a figure and return the line that shows it, or "" if the run has not drawn it."""
    path = ROOT / run / "figures" / f"{name}.png"
    if not path.exists():
        return ""
    shutil.copy(path, folder)
    title = re.split("[:.]", path.with_suffix(".rst").read_text())[0]
    return f"![{title}]({path.name})\n"


def setup(app):
    """Register `write_pages`, which Sphinx calls at the beginning of a build."""
    app.connect("builder-inited", write_pages)
    return {"parallel_read_safe": True}
