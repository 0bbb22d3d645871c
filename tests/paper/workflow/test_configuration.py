"""The paper's configuration is accepted; contradictions and wrong files are refused."""

import subprocess
import sys

import pytest
from helpers import configurations
from helpers.configurations import problems
from helpers.running import ROOT

from chatterjee1995.sections.configuration import configuration, without_left_out
from chatterjee1995.sections.reference import reference
from impact_damper.command.section import ConfigurationError, check_file

PAPER, SMALL = configurations.read(), configurations.small()


def changed(path, value):
    """Return the paper's configuration with another value at a path such as "search/starts"."""
    return configurations.changed(PAPER, path.split("/"), value)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("contact_stiffness", 1.0e9),
        ("curves/figure_05a/clearance", 0.002),
        ("curves/figure_10/restitution", 0.3),
        ("oscillators/h215/frequencies", {"first": 0.01, "last": 100}),
    ],
)
def test_the_paper_is_accepted_and_so_are_valid_extremes(path, value):
    for config in (PAPER, SMALL, changed(path, value)):
        configuration(config)


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        ("studies/design_plane/clearance/frist", 1, "first, last, points; did you mean first?"),
        ("figures/figure_05a/data", ["figure_5a"], "; did you mean figure_05a?"),
        ("results", "../results", "folder below the working directory"),
        ("scenes/chaos/accuracy/quantity", "state", "the motion is chaotic"),
        ("comparison/taylor", [1.0e-6, 1.0e-3], "must decrease"),
        ("comparison/scipy_periods", 39, "at least twice batch = 20"),
        ("settling/limit", 200, "at least settling.patience = 300"),
        ("design_rules/grid/frequencies", [2, 1.5], "must increase"),
        ("design_rules/linear_stiffness/frequencies", [1.5, 2], "above the linear frequency 1.5"),
        ("curves/figure_05a/clearance", "rule", "a number with stages other than harmonic_balance"),
        ("oscillators/h215/force", 0.0, "figure_03c_rule.clearance = 'rule': must be a number"),
        ("curves/figure_05a/restitution", 0.9, "it knows elastic contact only"),
        ("curves/figure_05a/stages", ["harmonic_balance"], "must hold response"),
        ("curves/free_h215/stages", ["subharmonic"], "must not hold subharmonic without a damper"),
        ("curves/free_h215/mass_ratio", 0.12, "clearance: missing; needed with mass_ratio (a damp"),
        ("search/starts", 1, "at least 2 with curves.figure_05a.stages subharmonic"),
        ("rigid_limit/figure_10/cells/stiffnesses", 100000, "at most 1000000 in all"),
        ("studies/design_plane/mass_ratio/points", 10**5, "chunks = 1: must be at least 5 with"),
        ("chunks", 1000, "must be at most 943 (the cells of studies.design_plane)"),
        ("balance_map/over_restitution/restitution", 1, "left out (it changes from row to row)"),
        ("balance_map/over_restitution/values/last", 1.5, "must be from 0.05 to 1"),
        ("figures/missed_contacts/data", ["grazing", "more"], "must be 1 at most"),
        ("figures/figure_01/data", ["elastic"], "one of elastic_model"),
        ("figures/figure_05a/data", ["free_h215"], "must be a curve with a damper"),
        ("figures/figure_02/data", ["figure_05a"], "must be a curve without a damper"),
        ("machines/pump/starts", 58, "machines.pump: starts = 58: must be from 59 "),
        ("machines/pump/contact", {"radius": "20 mm"}, "contact.youngs_modulus: missing; "),
    ],
)
def test_what_contradicts_is_answered_with_what_is_allowed(path, value, told):
    lines = problems(changed(path, value))
    assert any(told in line for line in lines), lines


def test_each_problem_has_its_line():
    config = changed("seed", -1)
    config["contact_stiffness"] = -2000
    config = configurations.changed(config, ("curves", "figure_10", "oscillator"), 1)
    told = [line.split(" ")[0].rstrip(":") for line in problems(config)]
    assert told == ["contact_stiffness", "curves.figure_10.oscillator", "seed"]
    assert problems(None) == ["configuration = None: must be keys with values"]


def test_repeated_keys_are_rejected_with_their_lines(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("curves:\n  a: {x: 1}\n  b: [{y: 1, y: 2}]\n  a: {x: 2}\n")
    with pytest.raises(ConfigurationError) as caught:
        check_file(path)
    assert sorted(str(caught.value).splitlines()) == [
        "mine.yaml, line 3: y stands twice: keep one",
        "mine.yaml, line 4: a stands twice: keep one",
    ]


@pytest.mark.parametrize("content", [b"seed: [1", b"a: 1\n---\nb: 2\n", b"seed: \xff\n"])
def test_a_file_that_is_no_yaml_is_told_in_one_line(content, tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_bytes(content)
    with pytest.raises(ConfigurationError, match="^mine.yaml: must be YAML in UTF-8.*$"):
        check_file(path)


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


def test_the_check_of_a_machine_imports_no_numba():
    code = (
        "import sys, yaml, chatterjee1995.sections.configuration as c; "
        "c.configuration(yaml.safe_load(open('config/config.yaml'))); "
        "print('numba' in sys.modules)"
    )
    run = {"capture_output": True, "text": True, "check": True, "cwd": ROOT}
    assert subprocess.run([sys.executable, "-c", code], **run).stdout == "False\n"


def test_the_reference_is_up_to_date():
    """To write it again: python -m chatterjee1995.sections.reference > config/reference.md"""
    assert (ROOT / "config/reference.md").read_text() == reference()
