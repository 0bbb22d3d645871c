"""Imports in the package run one way: from a room to itself or to a lower room.

A room is a subpackage of `impact_damper`. Every import in its files is read with `ast`, also
imports inside functions, so that none can hide an import of a higher room or a circle.
"""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "src" / "impact_damper"

# The rooms, the lowest first. A room may import itself and the rooms before it in this list.
FLOORS = (
    "system",
    "data",
    "machine",
    "kernel",
    "theory",
    "literature",
    "motions",
    "contact",
    "orbits",
    "edges",
    "absorbers",
    "attraction",
    "migration",
    "rivals",
    "comparisons",
    "performance",
    "design",
    "stages",
    "claims",
    "tables",
    "figures",
    "plot",
    "pages",
    "workflow",
)

MOST_FILES = 12
# Folders that may hold more than 12 files (not counting `__init__.py`), and why not to divide them.
LARGE = {
    "claims": "one file for each group of the paper's claims; none imports another",
    "data/variables": "one file for each subject of the datasets; none imports another",
    "design": "one file for each step of a design, and what the steps share",
    "figures": "one file for each kind of figure; they share only drawing and style",
    "kernel": "one file for each part of the kernel and of its compilation",
    "motions": "one file for each way to start or to run motions",
    "orbits": "one file for each way to find or to follow orbits, and what these share",
    "rivals": "one file for each integrator, and what they and the models share",
    "stages": "one file for each stage of the workflow; some stages have a second one",
    "tables": "one file for each subject; a subject's tables share the reading of its datasets",
    "theory": "one file for each approximation, and the mathematics they share",
    "workflow/models": "one file for each subject of the configuration, and what they share",
}

FILES = {
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted(PACKAGE.rglob("*.py"))
}


def imports_of(text, modules):
    """Return the set of those `modules` from which a source text imports.

    `from package import name` imports the module `package.name` if it exists, otherwise a name that
    `__init__.py` of the package defines, so that the import counts as one of the package.
    """
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
    """Return the room of a module, the second part of its name; "" for the package itself."""
    return module.partition(".")[2].partition(".")[0]


def upward_edges(imports, floors):
    """Return the wrong imports, as (importer, imported): of higher rooms or of the public names."""
    height = {room: floor for floor, room in enumerate(floors)} | {"": len(floors)}
    return sorted(
        (importer, imported)
        for importer, found in imports.items()
        for imported in found
        if height[room_of(imported)] > height[room_of(importer)]
    )


def circle(imports):
    """Return modules that import each other in a circle, or [] without a circle."""
    done = set()

    def search(module, path):
        if module in path:
            return path[path.index(module) :]
        if module in done:
            return []
        done.add(module)
        for imported in sorted(imports[module] - {module}):
            if found := search(imported, [*path, module]):
                return found
        return []

    return next(filter(None, (search(module, []) for module in imports)), [])


def test_every_room_has_a_floor():
    rooms = {path.name for path in PACKAGE.iterdir() if (path / "__init__.py").exists()}
    assert rooms == set(FLOORS)


def test_no_import_runs_upward(imports):
    assert upward_edges(imports, FLOORS) == []


def test_imports_form_no_circle(imports):
    assert circle(imports) == []


def test_large_rooms_have_a_reason():
    folders = {path.parent for path in FILES.values()} - {PACKAGE}
    counts = {
        folder.relative_to(PACKAGE).as_posix(): len(list(folder.glob("[!_]*.py")))
        for folder in folders
    }
    assert {room for room, count in counts.items() if count > MOST_FILES} <= set(LARGE)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("import a.low", {"a.low"}),
        ("from a import low", {"a.low"}),
        ("from a.low import name", {"a.low"}),
        ("from a import name", {"a"}),
        ("def late():\n    from a.low import name", {"a.low"}),
        ("import numpy", set()),
    ],
)
def test_every_way_to_import_is_read(text, expected):
    assert imports_of(text, {"a", "a.low"}) == expected


def test_an_upward_import_is_found():
    imports = {
        "a": {"a.high.x"},
        "a.low.x": {"a.high.x"},
        "a.high.x": {"a.low.y"},
        "a.low.y": {"a"},
    }
    assert upward_edges(imports, ("low", "high")) == [("a.low.x", "a.high.x"), ("a.low.y", "a")]


def test_a_circle_is_found():
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": set()}) == ["b", "c"]
    assert circle({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == []
