"""The paper's configuration is accepted; a broken one is told in a line for each problem."""

import copy
import math
from pathlib import Path

import pytest
import yaml
from helpers.broken import SMALL

from impact_damper.data.variables.studies import AXES
from impact_damper.figures import schematics
from impact_damper.workflow.configuration import (
    ConfigurationError,
    check_configuration,
    check_file,
    read_schemas,
    without_left_out,
)
from impact_damper.workflow.contradictions import SCHEMATICS

ROOT = Path(__file__).parents[2]
SCHEMAS = read_schemas(ROOT / "workflow/schemas")
PAPER = yaml.safe_load((ROOT / "config/config.yaml").read_text())


def problems(config):
    with pytest.raises(ConfigurationError) as caught:
        check_configuration(config, SCHEMAS)
    return str(caught.value).splitlines()


def changed(path, value, config=PAPER):
    """The paper's configuration, or another one, with one value set."""
    config = copy.deepcopy(config)
    *parents, key = path.split("/")
    place = config
    for name in parents:
        place = place[name]
    place[key] = value
    return config


def every_leaf(config, path=()):
    for key, value in config.items():
        if isinstance(value, dict):
            yield from every_leaf(value, (*path, key))
        else:
            yield (*path, key)


# One of each kind: entries of a section have the same keys.
LEAVES = {(path[0], path[-1]): "/".join(path) for path in every_leaf(SMALL)}.values()


def test_the_paper_is_accepted():
    check_configuration(PAPER, SCHEMAS)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("contact_stiffness", 1.0e-3),
        ("contact_stiffness", 1.0e9),
        ("curves/figure_05a/clearance", 0.002),
        ("curves/figure_05a/clearance", 1000),
        ("curves/figure_10/restitution", 0.3),
        ("curves/figure_05a/mass_ratio", 10),
        ("oscillators/h215/frequencies", {"first": 0.01, "last": 100}),
        ("optima/e090_rm012/restitution", 1.0),
    ],
)
def test_valid_extremes_are_accepted(path, value):
    check_configuration(changed(path, value), SCHEMAS)


@pytest.mark.parametrize("path", LEAVES)
@pytest.mark.parametrize("value", [math.nan, -math.inf, None, {}, [[]], True])
def test_no_leaf_takes_a_value_of_another_kind(path, value):
    lines = problems(changed(path, value, SMALL))
    assert all(line.startswith(path.replace("/", ".")) for line in lines)


@pytest.mark.parametrize("path", LEAVES)
def test_every_leaf_is_needed(path):
    config = copy.deepcopy(SMALL)
    *parents, key = path.split("/")
    place = config
    for name in parents:
        place = place[name]
    del place[key]
    (line,) = problems(config)
    assert line.startswith(f"{path.replace('/', '.')}: missing")


@pytest.mark.parametrize(
    "section", [name for name, value in PAPER.items() if isinstance(value, dict)]
)
def test_unknown_keys_are_rejected(section):
    (line,) = problems(changed(f"{section}/massratio", 0.12))
    assert line.startswith(f"{section}.massratio = 0.12: ")


@pytest.mark.parametrize(
    ("path", "value", "allowed"),
    [
        ("tolerance", 1.0e-9, "unknown key; known: balance_map, chunks, collisions"),
        ("seed", 0.5, "a whole number, at least 0"),
        ("contact_stiffness", 0, "at least 1e-06"),
        ("contact_stiffness", "2000", "a finite number"),
        ("points/simulated", 10**9, "at most 100000"),
        ("points/simulated", 45.0, "a whole number"),
        ("scenes/many_contacts/tolerance", "1e-9", "a finite number"),
        ("settling/scene", "quiet", "must be one of design"),
        ("scenes/chaos/accuracy/quantity", "state", "a chaotic motion is asked"),
        ("settling/limit", 200, "at least settling.patience = 300"),
        ("oscillators/h215/damping", -0.1, "at least 1e-09"),
        ("oscillators/h215/frequencies/first", 3, "less than last = 2.6"),
        ("optima/h215_rm012/clearances/last", 0.5, "less than last = 0.5"),
        ("release_scans/wide/frequencies/first", 2, "less than last = 2"),
        ("release_scans/wide/lifetime", 39, "at least 40, at most"),
        ("design_rules/grid/frequencies", [2, 1.5], "must increase"),
        ("design_rules/grid/mass_ratios", [0.12, 0.12], "must increase"),
        ("design_rules/linear_stiffness/frequencies", [1.5, 2], "above the linear frequency 1.5"),
        ("design_rules/grid/oscillator", "h216", "one of h215, h150, h107, l100, l150"),
        ("release_scans/wide/oscillator", "h216", "one of h215, h150, h107, l100, l150"),
        ("contact_model/figure_10/restitutions", [0.9, 0.3], "must increase"),
        ("contact_model/figure_10/frequencies", [2, 2], "must increase"),
        ("contact_model/figure_10/smallest_restitution", 1, "less than 1"),
        ("contact_model/figure_10/oscillator", "h216", "one of h215, h150, h107, l100, l150"),
        ("rigid_limit/figure_10/stiffnesses/first", 1.0e6, "less than last = 1000000.0"),
        ("rigid_limit/figure_10/frequencies/last", 1, "less than last = 1"),
        ("curves/figure_05a/mass_ratio", 0, "at least 1e-06"),
        ("curves/figure_05a/clearance", "Rule", "of the form rule"),
        ("curves/figure_05a/clearance", "rule", "a number with stages beside design"),
        ("curves/figure_05a/restitution", 1.2, "at most 1 (e, 1 for elastic contact"),
        ("curves/figure_05a/restitution", 0.9, "harmonic balance knows elastic contact only"),
        ("curves/figure_05a/oscillator", "h216", "one of h215, h150, h107, l100, l150"),
        ("curves/figure_05a/stages", [], "with 1 or more entries"),
        ("curves/figure_05a/stages", ["design"], "must hold response"),
        ("curves/figure_10/stages", ["response", "response"], "without repetition"),
        (
            "curves/figure_10/stages",
            ["responses"],
            "one of design, design_orbit, response, subharmonic",
        ),
        ("curves/a b", PAPER["curves"]["figure_10"], "a file name"),
        ("curves/new\n", PAPER["curves"]["figure_10"], "a file name"),
        ("curves/3", 3, "keys with values"),
        ("curves", {}, "with 1 or more entries"),
        ("figures/figure_05a/data", ["figure_5a"], "one of figure_03a"),
        ("balance_map/over_clearance/parameter", "frequency", "one of damping, mass_ratio"),
        ("studies/design_plane/mass_ratio/first", 0.7, "less than last = 0.5"),
        ("studies/design_plane/clearance/points", 10**9, "at most 100000"),
        ("studies/design_plane/clearance", 2, "must be a range (an axis of the map of figures"),
        ("studies/design_plane/restitution", 0.01, "at least 0.05"),
        (
            "studies/design_plane",
            PAPER["studies"]["design_plane"]
            | {key: {"first": 0.5, "last": 1, "points": 10**5} for key in AXES[:2]},
            "studies.design_plane: cells = 10000000000: must be at most 100000000",
        ),
        (
            "studies/design_plane/mass_ratio/points",
            10**5,
            "chunks = 4: must be at least 5 with the 4100000 cells of studies.design_plane",
        ),
        ("studies/design_plane/clearance/first", 1e-5, "must be at least search.radius/1000"),
        (
            "studies/design_plane",
            PAPER["studies"]["design_plane"]
            | {"mass_ratio": {"first": 1e-6, "last": 1, "points": 2}, "frequency": 0.01},
            "studies.design_plane.mass_ratio = 1e-06: with r1 = 2000 and W = 0.01 must be",
        ),
        (
            "studies/design_plane/frequency",
            {"first": 1, "last": 2, "points": 10**5},
            "points = 100000: must be at most 3 (panels of figures.design_plane",
        ),
        ("chunks", 1000, "must be at most 943 (the cells of studies.design_plane)"),
        ("balance_map/over_clearance/clearance", 2, "left out (it changes from row to row)"),
        ("balance_map/over_clearance/values", {"first": 2, "last": 1}, "less than last = 1"),
        ("balance_map/over_restitution/values/last", 1.5, "must be from 0.05 to 1"),
        ("balance_map/over_restitution/parameter", "clearance", "restitution: missing"),
        ("figures/figure_05a/data", [], "with 1 or more entries"),
        ("figures/figure_05a/kind", "curve", "one of schematic, free"),
        ("figures/figure_01/data", ["elastic"], "one of elastic_model"),
        ("figures/figure_06/data", ["h215_rm012"] * 2, "without repetition"),
        ("comparison/taylor", [1.0e-6, 1.0e-3], "must decrease"),
        ("comparison/merson", [1.0e-3, 1.0e-3], "must decrease"),
        ("comparison/scipy_periods", 39, "at least twice batch = 20"),
        ("scenes/chaos/periods", 39, "at least twice comparison.batch = 20"),
        ("search/starts", 1, "at least 2 with curves.figure_05a.stages subharmonic"),
        ("search/starts", 1000000, "makes 201000000: must be at most 1000000 in all"),
        ("search/radius", 1000, "curves.figure_05c.clearance = 0.625: must be at least search.ra"),
        ("points/map_values", 100000, "points.map_values = 100000: with points.map_frequencies"),
        ("rigid_limit/figure_10/cells/stiffnesses", 100000, "at most 1000000 in all"),
        ("missed_contacts/grazing/steps/last", 16, "11 whole numbers fit"),
        ("verdicts/orbits/free/quiet", PAPER["verdicts"]["orbits"]["free"]["subharmonic"], "anoth"),
        ("figures/verdicts/data", ["orbits", "more"], "must be 1 at most"),
        ("figures/figure_01/data", ["elastic_model", "algorithm"], "must be 1 at most"),
        ("curves/figure_03c_rule/mass_ratio", 1.0e-6, "at most 1000 (the clearance of the rule"),
        ("rigid_limit/figure_10/mass_ratio", 1.0e-6, "so large that sqrt(r1 (1 + 1/rm))/W ="),
        ("contact_stiffness", 1.0e-7, "at least 1e-06"),
        (f"curves/{'a' * 65}", PAPER["curves"]["figure_10"], "a file name"),
        ("cur\nves", 3, "'cur\\nves' = 3: unknown key"),
        ("results", "../results", "folder below the working directory"),
        ("results", "/results", "folder below the working directory"),
        ("results", "my results", "without spaces"),
    ],
)
def test_a_broken_value_is_told_with_what_is_allowed(path, value, allowed):
    lines = problems(changed(path, value))
    assert any(allowed in line for line in lines), lines


def test_a_name_that_is_no_text_is_rejected():
    config = copy.deepcopy(PAPER)
    config["curves"][3] = config["curves"]["figure_10"]
    assert problems(config) == [
        "curves.3: name must be text, of the form [A-Za-z0-9][A-Za-z0-9_]{0,63} "
        "(a name becomes part of a file name)"
    ]


@pytest.mark.parametrize("config", [None, [], "config", 3])
def test_a_configuration_without_keys_is_rejected(config):
    assert problems(config) == [f"configuration = {config!r}: must be keys with values"]


def test_each_problem_has_its_line():
    config = changed("seed", -1)
    config["contact_stiffness"] = -2000
    del config["curves"]["figure_10"]["oscillator"]
    assert [line.split(" ")[0].rstrip(":") for line in problems(config)] == [
        "contact_stiffness",
        "curves.figure_10.oscillator",
        "seed",
    ]


def test_repeated_keys_are_rejected_with_their_lines(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("curves:\n  a: {x: 1}\n  b: [{y: 1, y: 2}]\n  a: {x: 2}\n")
    with pytest.raises(ConfigurationError) as caught:
        check_file(path)
    assert sorted(str(caught.value).splitlines()) == [
        "mine.yaml, line 3: y stands twice: keep one",
        "mine.yaml, line 4: a stands twice: keep one",
    ]


@pytest.mark.parametrize("name", ["config.yaml", "smoke.yaml"])
def test_our_own_files_repeat_no_key(name):
    check_file(ROOT / "config" / name)


@pytest.mark.parametrize(
    "content",
    [b"seed: [1", b"a: 1\n---\nb: 2\n", b"seed: \xff\n", b"seed: \x00\n"],
)
def test_a_file_that_is_no_yaml_is_told_in_one_line(content, tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_bytes(content)
    with pytest.raises(ConfigurationError, match="^mine.yaml: must be YAML in UTF-8.*$"):
        check_file(path)


def test_a_file_that_holds_itself_is_read_to_its_end(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("curves: &a\n  x: *a\n  ? [a, b]\n  : 3\n")
    check_file(path)


def test_every_schematic_has_its_drawing():
    assert all(callable(getattr(schematics, name)) for name in SCHEMATICS)


def test_entries_set_to_null_are_left_out_with_what_only_they_are_drawn_for():
    config = {
        "curves": {"a": {"mass_ratio": 0.1}, "b": None},
        "figures": {
            "both": {"kind": "design", "data": ["a", "b"]},
            "none": {"kind": "design", "data": ["b"]},
            "dropped": None,
        },
    }
    kept = without_left_out(config)
    assert kept["curves"] == {"a": {"mass_ratio": 0.1}}
    assert kept["figures"] == {"both": {"kind": "design", "data": ["a"]}}


@pytest.mark.parametrize("config", [{"figures": {"a": 5}}, {"figures": {"a": {"kind": "design"}}}])
def test_leaving_out_passes_on_what_the_schema_rejects(config):
    assert without_left_out(config | {"curves": 5}) == config | {"curves": 5}


def test_a_damper_is_whole_or_absent():
    config = copy.deepcopy(PAPER)
    scene = config["harmonics"]["soft"]
    del scene["clearance"], scene["restitution"]
    assert [line.split(":")[0] for line in problems(config)] == [
        "harmonics.soft.clearance",
        "harmonics.soft.restitution",
    ]
