"""The paper's configuration is accepted; a wrong one is refused with a line for each problem."""

import copy
import math
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest
from helpers import configurations
from helpers.broken import SMALL

from chatterjee1995.figures import schematics
from chatterjee1995.sections.configuration import configuration, without_left_out
from chatterjee1995.sections.report import SCHEMATICS
from chatterjee1995.variables.studies import AXES
from chatterjee1995.workflow.reference import reference
from impact_damper.command.yaml_files import ConfigurationError, check_file
from impact_damper.model.bounds import CLEARANCE_RANGE, FREQUENCY_RANGE
from impact_damper.model.parameters import Damper, Oscillator, parameters_in

ROOT = Path(__file__).parents[3]
PAPER = configurations.read()
KNOWN = "one of h215, h150, h107, l100, l150"


def problems(config):
    """Return the lines with which a configuration is refused."""
    with pytest.raises(ConfigurationError) as caught:
        configuration(config)
    return str(caught.value).splitlines()


def changed(path, value, config=PAPER):
    """Return the paper's configuration, or another one, with one value changed."""
    config = copy.deepcopy(config)
    *parents, key = path.split("/")
    place = config
    for name in parents:
        place = place[name]
    place[key] = value
    return config


def without(path):
    """Return the paper's configuration without one key."""
    config = copy.deepcopy(PAPER)
    *parents, key = path.split("/")
    place = config
    for name in parents:
        place = place[name]
    del place[key]
    return config


def leaves(config, path=()):
    """Yield the path of each value that is not a mapping."""
    for key, value in config.items():
        if isinstance(value, dict):
            yield from leaves(value, (*path, key))
        else:
            yield (*path, key)


def with_all_leaves(value):
    """Return the small configuration with `value` for each value that is not a mapping."""

    def replaced(part):
        return {k: replaced(x) if isinstance(x, dict) else value for k, x in part.items()}

    return replaced(SMALL)


def test_the_paper_is_accepted():
    configuration(PAPER)


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
        ("optimum/e090_rm012/restitution", 1.0),
    ],
)
def test_valid_extremes_are_accepted(path, value):
    configuration(changed(path, value))


@pytest.mark.parametrize("value", [math.nan, -math.inf, {}, [[]], True])
def test_each_value_of_another_kind_has_its_line(value):
    """If all values are wrong at once, there is a line for each; the line begins with the key."""
    lines = problems(with_all_leaves(value))
    # In place of a number of a study, an empty mapping counts as a range that lacks its keys.
    lines = [line for line in lines if not line.endswith("needed here: first, last, points")]
    keys = {".".join(path) for path in leaves(SMALL)}
    told = {line.split(" = ")[0] for line in lines}
    ranges = {f"studies.design_plane.{key}" for key in AXES} if value == {} else set()
    # If the value is the list [[]] where a list is allowed, its first entry, `key.0`, is wrong.
    assert {key if key in keys else key.removesuffix(".0") for key in told} == keys - ranges
    assert all(" = " in line and ": must be " in line for line in lines)


def test_each_missing_value_has_its_line():
    """If all values are missing at once, there is a line for each that is not optional."""

    def emptied(part):
        return {key: emptied(value) for key, value in part.items() if isinstance(value, dict)}

    damper = ("mass_ratio", "clearance", "restitution")
    optional = {
        "curves": damper,
        "optimum": ("starts",),
        "scenes": damper,
        "harmonic_convergence": (*damper, "contact_stiffness"),
        "balance_map": ("damping", *damper),
        "machines": (
            "linear_stiffness",
            "damping_ratio",
            "force",
            "base_displacement",
            "contact_stiffness",
        ),
    }
    needed = {
        ".".join(path)
        for path in leaves(SMALL)
        if path[-1] not in optional.get(path[0], ())
        and path[0] != "captions"
        and path[::2] != ("machines", "tolerances")
    } - {f"studies.design_plane.{key}.{end}" for key in AXES for end in ("first", "last", "points")}
    lines = [line for line in problems(emptied(SMALL)) if not line.startswith("captions.")]
    missing = {line.split(": missing; needed here: ")[0] for line in lines}
    axes = {key for key in missing if key.startswith("studies.design_plane.")}
    assert needed <= missing and missing - needed <= axes
    assert len(lines) == len(missing)


@pytest.mark.parametrize(
    "section", [name for name, value in PAPER.items() if isinstance(value, dict)]
)
def test_unknown_keys_are_rejected(section):
    (line,) = problems(changed(f"{section}/massratio", 0.12))
    assert line.startswith(f"{section}.massratio = 0.12: ")


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("curves/figure_05a/massratio", "known: clearance, mass_ratio, oscillator, restitution"),
        ("curves/figure_05a/massratio", "; did you mean mass_ratio?"),
        ("optima", "; did you mean optimum?"),
        ("settling/patients", "; did you mean patience?"),
        ("studies/design_plane/clearance/frist", "known: first, last, points; did you mean first?"),
    ],
)
def test_an_unknown_key_is_answered_with_the_nearest_known_one(path, told):
    (line,) = problems(changed(path, 0.12))
    assert line.startswith(f"{path.replace('/', '.')} = 0.12: unknown key; ") and told in line


@pytest.mark.parametrize(
    ("path", "value", "allowed"),
    [
        (
            "tolerance",
            1.0e-9,
            "unknown key; known: balance_map, basins, captions, chunks",
        ),
        ("seed", 0.5, "a whole number, at least 0"),
        ("contact_stiffness", 0, "at least 1e-06"),
        ("contact_stiffness", "2000", "a finite number"),
        ("points/simulated", 10**9, "at most 100000"),
        ("points/simulated", 45.0, "a whole number"),
        ("settling/tolerance", "1e-9", "a finite number"),
        ("scenes/chaos/accuracy/quantity", "state", "the motion is chaotic"),
        ("settling/limit", 200, "at least settling.patience = 300"),
        ("oscillators/h215/damping", -0.1, "at least 1e-09"),
        ("oscillators/h215/frequencies/first", 3, "less than last = 2.6"),
        ("optimum/h215_rm012/clearances/last", 0.5, "less than last = 0.5"),
        ("release_scan/wide/frequencies/first", 2, "less than last = 2"),
        ("release_scan/wide/lifetime", 39, "at least 40, at most"),
        ("design_rules/grid/frequencies", [2, 1.5], "must increase"),
        ("design_rules/grid/mass_ratios", [0.12, 0.12], "must increase"),
        ("design_rules/linear_stiffness/frequencies", [1.5, 2], "above the linear frequency 1.5"),
        ("design_rules/grid/oscillator", "h216", KNOWN),
        ("release_scan/wide/oscillator", "h216", KNOWN),
        ("contact_model/figure_10/restitutions", [0.9, 0.3], "must increase"),
        ("contact_model/figure_10/frequencies", [2, 2], "must increase"),
        ("contact_model/figure_10/smallest_restitution", 1, "less than 1"),
        ("contact_model/figure_10/oscillator", "h216", KNOWN),
        ("rigid_limit/figure_10/stiffnesses/first", 1.0e6, "less than last = 1000000.0"),
        ("rigid_limit/figure_10/frequencies/last", 1, "less than last = 1"),
        ("curves/figure_05a/mass_ratio", 0, "at least 1e-06"),
        ("curves/figure_05a/clearance", "Rule", "of the form rule"),
        ("curves/figure_05a/clearance", "rule", "a number with stages other than harmonic_balance"),
        ("curves/figure_05a/restitution", 1.2, "at most 1 (e, 1 for elastic contact"),
        ("curves/figure_05a/restitution", 0.9, "it knows elastic contact only"),
        ("curves/figure_05a/oscillator", "h216", KNOWN),
        ("curves/figure_05a/stages", [], "with 1 or more entries"),
        ("curves/figure_05a/stages", ["harmonic_balance"], "must hold response"),
        ("curves/figure_10/stages", ["response", "response"], "without repetition"),
        (
            "curves/figure_10/stages",
            ["responses"],
            "one of harmonic_balance, design_orbit, response, subharmonic",
        ),
        ("curves/a b", PAPER["curves"]["figure_10"], "a file name"),
        ("curves/new\n", PAPER["curves"]["figure_10"], "a file name"),
        ("curves/3", 3, "keys with values"),
        ("curves", {}, "with 1 or more entries"),
        ("figures/figure_05a/data", ["figure_5a"], "one of free_h215, "),
        ("balance_map/over_mass_ratio/parameter", "frequency", "one of damping, mass_ratio"),
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
            "chunks = 1: must be at least 5 with the 4100000 cells of studies.design_plane",
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
        ("balance_map/over_mass_ratio/mass_ratio", 0.2, "left out (it changes from row to row)"),
        ("balance_map/over_mass_ratio/values", {"first": 2, "last": 1}, "less than last = 1"),
        ("balance_map/over_restitution/values/last", 1.5, "must be from 0.05 to 1"),
        ("balance_map/over_restitution/parameter", "clearance", "restitution: missing"),
        ("figures/figure_05a/data", [], "with 1 or more entries"),
        ("figures/figure_05a/kind", "curve", "one of harmonic_balance, free, motion"),
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
        ("figures/missed_contacts/data", ["grazing", "more"], "must be 1 at most"),
        ("figures/figure_01/data", ["elastic_model", "algorithm"], "must be 1 at most"),
        ("curves/figure_03c_rule/mass_ratio", 1.0e-6, "at most 1000 (`rule` gives this"),
        (
            "oscillators/h215/force",
            0.0,
            "figure_03c_rule: no clearance by `rule` with",
        ),
        ("rigid_limit/figure_10/mass_ratio", 1.0e-6, "so large that sqrt(r1 (1 + 1/rm))/W ="),
        ("contact_stiffness", 1.0e-7, "at least 1e-06"),
        (f"curves/{'a' * 65}", PAPER["curves"]["figure_10"], "a file name"),
        ("cur\nves", 3, "'cur\\nves' = 3: unknown key"),
        ("results", "../results", "folder below the working directory"),
        ("results", "/results", "folder below the working directory"),
        ("results", "my results", "without spaces"),
        ("curves/free_h215/mass_ratio", 0.12, "clearance: missing; needed with mass_ratio (a damp"),
        ("curves/free_h215/stages", ["subharmonic"], "must not hold subharmonic without a damper"),
        (
            "curves/free_h215/stages",
            ["response"],
            "figures.figure_05a.data.0 = 'figure_05a': must have beside it an entry of curves with "
            "the oscillator h215, no damper, and the stage branches",
        ),
        ("figures/figure_05a/data", ["free_h215"], "must be a curve with a damper"),
        ("figures/figure_02/data", ["figure_05a"], "must be a curve without a damper"),
        ("figures/figure_05a/data", ["figure_5a"], "; did you mean figure_05a?"),
    ],
)
def test_a_broken_value_is_answered_with_what_is_allowed(path, value, allowed):
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
            "both": {"kind": "harmonic_balance", "data": ["a", "b"]},
            "none": {"kind": "harmonic_balance", "data": ["b"]},
            "dropped": None,
        },
    }
    kept = without_left_out(config)
    assert kept["curves"] == {"a": {"mass_ratio": 0.1}}
    assert kept["figures"] == {"both": {"kind": "harmonic_balance", "data": ["a"]}}


@pytest.mark.parametrize("figures", [5, [1], {"a": 5}, {"a": {"kind": "harmonic_balance"}}])
@pytest.mark.parametrize("curves", [5, {"b": {}}])
def test_leaving_out_passes_on_what_the_check_refuses(figures, curves):
    config = {"figures": figures, "curves": curves}
    assert without_left_out(config) == config


def test_names_of_another_kind_are_no_entries_left_out():
    config = {
        "figures": {"a": {"kind": "harmonic_balance", "data": [[], {}]}},
        "curves": {"b": None},
    }
    assert without_left_out(config) == config | {"curves": {}}


def test_a_damper_is_whole_or_absent():
    config = copy.deepcopy(PAPER)
    scene = config["harmonic_convergence"]["soft"]
    del scene["clearance"], scene["restitution"]
    assert [line.split(":")[0] for line in problems(config)] == [
        "harmonic_convergence.soft.clearance",
        "harmonic_convergence.soft.restitution",
    ]


def test_a_curve_without_the_free_one_is_drawn_by_no_figure():
    lines = problems(without("curves/free_h107"))
    assert [line.split(" = ")[0] for line in lines] == ["figures.figure_08.data.0"]


def bounds():
    """Yield the path of a key in the small configuration, and its bounds in the library."""
    for each in parameters_in(Oscillator):
        if each.name != "shaker":  # only machines can stand on a shaker, and have other keys
            yield f"oscillators/h215/{each.name}", each.metadata["bounds"]
    for each in fields(Damper):
        key = "" if each.name == "contact_stiffness" else "curves/figure_05a/"
        yield key + each.name, each.metadata["bounds"]
    yield "motion/figure_04/frequency", FREQUENCY_RANGE
    yield "optimum/h215_rm012/clearances/first", CLEARANCE_RANGE


@pytest.mark.parametrize(("path", "known"), list(bounds()))
def test_the_configuration_has_the_bounds_of_the_library(path, known):
    """A value at an end of its range is accepted; the next number beyond it is refused."""
    key = path.replace("/", ".")
    for end, direction in ((known["least"], -math.inf), (known["most"], math.inf)):
        beyond = math.nextafter(end, direction)
        lines = problems(changed(path, beyond, SMALL))
        assert [line.startswith(f"{key} = {beyond!r}: must be a finite n") for line in lines] == [
            True
        ]
        try:
            configuration(changed(path, end, SMALL))
        except ConfigurationError as error:
            assert "a finite number" not in str(error)


def test_the_check_imports_no_numpy():
    """The check runs at every dry run, and NumPy takes long to import."""
    code = "import sys, chatterjee1995.sections.configuration; print('numpy' in sys.modules)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout == "False\n"


def test_the_check_of_a_machine_imports_no_numba():
    code = (
        "import sys, yaml, chatterjee1995.sections.configuration as c; "
        "c.configuration(yaml.safe_load(open('config/config.yaml'))); "
        "print('numba' in sys.modules)"
    )
    run = {"capture_output": True, "text": True, "check": True, "cwd": ROOT}
    assert subprocess.run([sys.executable, "-c", code], **run).stdout == "False\n"


def test_the_reference_is_up_to_date():
    """To write it again: python -m chatterjee1995.workflow.reference > config/reference.md"""
    assert (ROOT / "config/reference.md").read_text() == reference()


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        ("damper/mass", "13 kg", "damper.mass = '13 kg': must be "),
        ("band/last", 20.4, "band = 20.3 Hz to 20.4 Hz: must "),
        ("starts", 72, "starts = 72: must be from 73 "),
        ("tolerances/gap", "110 %", "tolerances.gap = '110 %': must be "),
        ("tolerances/force", 1.0, "tolerances.force = 1.0: must be "),
        ("candidates", 3, "candidates = 3: must be "),
        ("band/points", 2, "band.points = 2: must be "),
        ("contact", {"radius": "20 mm"}, "contact.youngs_modulus: missing; "),
        ("machine/force", None, "machine.force = None: must be "),
    ],
)
def test_a_machine_is_refused_in_the_words_of_its_user(path, value, told):
    lines = problems(changed(f"machines/pump/{path}", value))
    assert lines[0].startswith(f"machines.pump.{told}"), lines
