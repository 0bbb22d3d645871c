"""Imports in the package run one way: from a room to itself or to a lower room."""

import ast
from collections import Counter
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[1] / "src"
LIBRARY, PAPER = "impact_damper", "chatterjee1995"

# The rooms, the lowest first. A room may import itself and the rooms before it in this list. The
# library never imports the paper.
FLOORS = (
    "impact_damper.model",
    "impact_damper.data",
    "impact_damper.kernel",
    "impact_damper.theory",
    "impact_damper.motions",
    "impact_damper.orbits",
    "impact_damper.design",
    "impact_damper.plot",
    "impact_damper.command",
    "impact_damper",
    "chatterjee1995",
    "chatterjee1995.methods",
    "chatterjee1995.stages",
    "chatterjee1995.reading",
    "chatterjee1995.tables",
    "chatterjee1995.claims",
    "chatterjee1995.figures",
    "chatterjee1995.sections",
    "chatterjee1995.workflow",
)
HIGHEST = 8  # most floors, if each room stands as low as its imports allow
MOST_FILES = 16  # most files of a room, its `__init__.py` not counted

FILES = {
    ".".join(path.relative_to(SOURCES).with_suffix("").parts).removesuffix(".__init__"): path
    for package in (LIBRARY, PAPER)
    for path in sorted((SOURCES / package).rglob("*.py"))
}


def imports_of(text, modules):
    """Return the set of the modules among `modules` from which a source text imports."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"line {node.lineno}: relative import"
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                found.add(inner if inner in modules else node.module)
    return found & modules


@pytest.fixture(scope="module")
def imports():
    """Return the imports of each module of the package, keyed by module."""
    return {name: imports_of(path.read_text(), set(FILES)) for name, path in FILES.items()}


def room_of(module):
    """Return the room of a module, the first two parts of its name."""
    return ".".join(module.split(".")[:2])


def test_every_room_has_a_floor():
    assert set(map(room_of, FILES)) == set(FLOORS)


def test_no_import_runs_upward(imports):
    upward = [
        (importer, imported)
        for importer, found in imports.items()
        for imported in found
        if FLOORS.index(room_of(imported)) > FLOORS.index(room_of(importer))
    ]
    assert upward == []


def test_imports_form_no_circle(imports):
    """A CycleError names the modules of the circle."""
    TopologicalSorter({name: found - {name} for name, found in imports.items()}).prepare()


def test_no_room_is_crowded():
    counts = Counter(path.parent for path in FILES.values() if path.stem != "__init__")
    crowded = {path.relative_to(SOURCES).as_posix(): n for path, n in counts.items()}
    assert {name: count for name, count in crowded.items() if count > MOST_FILES} == {}


def test_the_rooms_have_few_floors(imports):
    below = {room: set() for room in FLOORS}
    for importer, found in imports.items():
        below[room_of(importer)] |= set(map(room_of, found)) - {room_of(importer)}
    heights = {}
    for room in FLOORS:
        heights[room] = 1 + max((heights[each] for each in below[room]), default=0)
    assert max(heights.values()) <= HIGHEST, heights
