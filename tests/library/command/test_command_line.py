"""The command `impact-damper` gives the answers of the library, and refuses wrong files."""

import json
import subprocess
import sys
from html import unescape
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest
from helpers.design_tasks import needs_compiler
from helpers.made_up_design import made_up_design
from matplotlib.figure import Figure
from references.built import by_program
from typer.testing import CliRunner

import impact_damper as idm
from impact_damper.command import command_line
from impact_damper.command.machine_file import design_arguments, read_machine_file
from impact_damper.command.section import ConfigurationError
from impact_damper.data.datasets import load
from impact_damper.design.migration import migration
from impact_damper.design.task import Task
from impact_damper.model.machine import Machine, describe_si
from impact_damper.plot.machine_figures import FIGURES

FILE = """
machine: {mass: 12 kg, linear_stiffness: 2e5 N/m, damping_ratio: 5 %, force: 40 N}
damper: {mass: 0.6 kg, restitution: 0.7, contact_stiffness: 2e6 N/m}
band: [20 Hz, 21 Hz]
"""


@pytest.fixture
def machine_file(tmp_path):
    """A file that describes a machine with the fewest possible keys."""
    path = tmp_path / "machine.yaml"
    path.write_text(FILE)
    return path


def run(*arguments):
    """Run the command, and return what it printed."""
    result = CliRunner().invoke(command_line.app, [str(each) for each in arguments])
    assert result.exit_code == 0, result.output
    assert "%|" not in result.stderr  # no progress bar, because this is no terminal
    return result.stdout


def refused(*arguments):
    """Run the command, and return the error that ended it."""
    return CliRunner().invoke(command_line.app, [str(each) for each in arguments]).exception


def test_motion_without_a_damper_has_the_linear_amplitude(machine_file):
    """The amplitude is F/sqrt((k - m w^2)^2 + (c w)^2) once the transient has decayed."""
    told = run("simulate", machine_file, "--frequency", "24 Hz", "--periods", 300, "--json")
    w, k, m = 2 * np.pi * 24, 2e5, 12
    exact = 40 / np.hypot(k - m * w**2, 2 * 0.05 * np.sqrt(k * m) * w)
    assert json.loads(told)["largest_displacement_mm"] == pytest.approx(1e3 * exact, rel=1e-3)


def test_motion_is_kept_in_a_file(machine_file, tmp_path):
    """The file holds the dataset that `simulate` of the library returns."""
    kept = tmp_path / "motion.nc"
    run("simulate", machine_file, "--frequency", 20.5, "--gap", "2 mm", "--periods", 20,
        "--state", "1 mm, 0, 0, 0.1 m/s", "--output", kept)  # fmt: skip
    machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.05, force=40)
    damper = machine.damper(mass=0.6, gap=2e-3, restitution=0.7, contact_stiffness=2e6)
    motion = idm.simulate(machine, damper, 20.5, (1e-3, 0, 0, 0.1), periods=20)
    np.testing.assert_array_equal(load(kept)["displacement"], motion["displacement"])


def test_a_motion_and_its_mirror_image_are_told_once_with_their_starts(machine_file):
    """The shares that the command tells sum to the shares of all motions of the library."""
    asked = ("--gap", "2.5 mm", "--starts", 12, "--json")
    told = json.loads(run("response", machine_file, *asked))["response"]
    given = read_machine_file(machine_file)
    machine = Machine(**given["machine"])
    damper = command_line.damper(given, machine, "2.5 mm")
    frequencies = [row["frequency_hz"] for row in told]
    found = idm.frequency_response(machine, damper, frequencies, starts=12)
    for i, row in enumerate(told):
        sizes = row["settled_mm"] + row["other_mm"]
        shares = row["settled_share"] + row["other_share"]
        assert len({f"{size:.4g}" for size in sizes}) == len(sizes)
        assert 12 * sum(shares) == pytest.approx(np.maximum(found["motion_starts"][i], 0).sum())


@pytest.fixture(autouse=True)
def blank_figures(monkeypatch):
    """Put blank sheets in place of figures, which `plot/test_machine_figures.py` draws."""
    for name in FIGURES:
        monkeypatch.setitem(FIGURES, name, lambda _: Figure(figsize=(1, 1)))


@pytest.fixture
def made_up(monkeypatch):
    """The design that `design` and `evaluate` return in place of their own, for FILE's machine."""
    machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.05, force=40)
    found = made_up_design(told={"machine": describe_si(machine)})
    asked = {}

    def decide(*given, **options):
        asked.update(options, given=given)
        return found.copy()

    module = "impact_damper.design.design_damper"
    monkeypatch.setattr(f"{module}.design_damper", decide)
    monkeypatch.setattr(f"{module}.evaluate_damper", decide)
    return asked


@pytest.mark.parametrize("command", ["design", "evaluate"])
def test_an_answer_is_told_and_kept_with_its_page(command, machine_file, made_up, tmp_path):
    gap = ("--gap", "2 mm") if command == "evaluate" else ()
    folder = tmp_path / "out"
    told = json.loads(run(command, machine_file, *gap, "--output", folder, "--json"))
    assert told["design_gap_mm"] == 7 and told["decision"] == "build"
    assert told["promised_displacement_mm"] == 1 and told["limit_status"] == "none"
    assert not made_up["progress"]  # standard error is no terminal
    if gap:
        assert made_up["given"][1].gap == pytest.approx(0.002)
    page = Path(told["page"]).read_text()
    assert all(text in unescape(page) for text in told["conclusion"])
    assert "from machine.yaml" in page
    lines = run(command, machine_file, *gap, "--output", folder).splitlines()
    assert lines[:-1] == told["conclusion"] and lines[-1].endswith("index.html")
    run("report", told["data"], "--output", tmp_path / "again")
    assert (tmp_path / "again" / "index.html").read_text() == page


def test_results_of_others_are_not_replaced(machine_file, made_up, tmp_path):
    folder = tmp_path / "out"
    run("design", machine_file, "--output", folder)
    other = tmp_path / "other.yaml"
    other.write_text(FILE.replace("40 N", "41 N"))
    made_up.clear()
    assert "is of another machine" in str(refused("design", other, "--output", folder))
    (folder / "index.html").write_text("<p>")
    assert "is no page of" in str(refused("design", machine_file, "--output", folder))
    assert not made_up  # nothing was computed
    run("design", other, "--output", folder, "--force")


@pytest.mark.parametrize("command", ["design", "migrate", "response", "simulate --frequency 20"])
def test_a_folder_that_cannot_be_written_is_named_first(command, machine_file, made_up):
    others = ("--gap", 9) if command[0] in "rs" else ()  # 9 m would be refused later
    error = refused(*command.split(), machine_file, *others, "--output", machine_file / "out")
    assert isinstance(error, OSError) and not made_up
    assert "machine.yaml" in str(error) and "cannot be written" in str(error)


def test_releases_of_a_damper_are_those_of_the_library(machine_file, tmp_path):
    hard = FILE.replace("2e5 N/m,", "2e5 N/m, cubic_stiffness: 4e9,").replace("5 %", "2 %")
    band = hard.replace("[20 Hz, 21 Hz]", "{first: 22 Hz, last: 24 Hz, points: 3}")
    machine_file.write_text(f"{band}candidates: 4\n")
    asked = ("migrate", machine_file, "--output", tmp_path / "out")
    lines, told = run(*asked), json.loads(run(*asked, "--json"))
    found, given = load(told["data"]), read_machine_file(machine_file)
    effort = idm.Effort(frequencies=3, candidates=4, starts=73)
    values = {"mass": 0.6, "restitution": 0.7, "contact": 2e6, "band": (22, 24)}
    same = migration(Machine(**given["machine"]), **values, effort=effort)
    np.testing.assert_array_equal(found["migration_bound"], same["migration_bound"])
    for row, gap in zip(told["migration"], same["released_gap"], strict=True):
        times = same.sel(released_gap=gap, released_frequency=row["sure_from_hz"])
        assert times["migration_time"] == row["median_s"] < row["bound_s"]
        assert row["bound_s"] == times["migration_bound"] and f"{row['bound_s']:.4g}" in lines
    assert (tmp_path / "out" / "migration.png").exists()
    machine_file.write_text(machine_file.read_text().replace("40 N", "41 N"))
    assert "is of another machine" in str(refused(*asked))


def test_all_commands_compute_with_the_stiffness_of_a_ball(machine_file):
    """The stiffness is for an impact at the speed that crosses the rule's gap in half a cycle."""
    ball = "contact: {radius: 20 mm, youngs_modulus: 3 GPa, poissons_ratio: 0.4}\n"
    machine_file.write_text(FILE.replace(", contact_stiffness: 2e6 N/m", "") + ball)
    given = read_machine_file(machine_file)
    task = Task(machine=Machine(**given["machine"]), **design_arguments(given))
    speed = 2 * task.rule_gap(20.5) * 20.5  # in the middle of the band
    found = command_line.damper(given, task.machine, "3 mm").contact_stiffness
    expected = idm.HertzContact("20 mm", "3 GPa", 0.4).stiffness(speed, 12 * 0.6 / 12.6)
    assert found == task.contact_stiffness == pytest.approx(expected)


@pytest.mark.thorough
@needs_compiler
def test_a_vertical_damper_with_friction_is_designed_from_a_file(machine_file, tmp_path):
    """New starts keep its promise in a C program that shares no code with the library."""
    mount = "inclination: 90 deg, friction_coefficient: 0.2, normal_force: 3 N"
    text = FILE.replace("5 %", "0.5 %").replace("0.6 kg", f"1.2 kg, {mount}")
    machine_file.write_text(f"{text}candidates: 4\nfrequencies: 3\nstarts: 59\n")
    told = json.loads(run("design", machine_file, "--output", tmp_path / "out", "--json"))
    given, machine = command_line.read(machine_file)
    damper = command_line.damper(given, machine, f"{told['design_gap_mm']} mm")
    assert (damper.gravity, damper.friction) == pytest.approx((9.81, 0.6))
    states = np.random.default_rng(1).uniform(-1, 1, (20, 4)) * [2e-3, 0.2, damper.gap / 2, 0.2]
    runs = [1e3 * by_program(machine, damper, 20.5, each, 700, 600) for each in states]
    assert sum(size > told["promised_displacement_mm"] for size in runs) <= 3
    assert told["promised_displacement_mm"] < 0.5 * told["largest_bare_displacement_mm"]


def test_a_contact_that_is_not_known_names_its_key(machine_file):
    machine_file.write_text(FILE.replace(", contact_stiffness: 2e6 N/m", ""))
    with pytest.raises(ConfigurationError, match="damper.contact_stiffness: missing; needed here"):
        read_machine_file(machine_file)


def test_wrong_value_names_key_and_range(machine_file):
    """The message has all problems at once, and suggests the nearest key."""
    machine_file.write_text(FILE.replace("0.7", "7").replace("force", "froce"))
    with pytest.raises(ConfigurationError) as raised:
        read_machine_file(machine_file)
    assert "damper.restitution = 7" in str(raised.value)
    assert "did you mean force?" in str(raised.value)


def test_frequencies_and_tolerances_in_the_words_of_python(machine_file):
    """A file's `frequencies` and absolute tolerances mean what they mean for `design_damper`."""
    tolerances = "{gap: 0.1 mm, force: 2 N, gravity: 2 %, friction: 0.3}"
    machine_file.write_text(f"{FILE}frequencies: 15\ntolerances: {tolerances}\n")
    given = read_machine_file(machine_file)
    assert given["band"]["points"] == 15
    task = Task(machine=Machine(**given["machine"]), **design_arguments(given))
    np.testing.assert_allclose(task.deviations(2.0), [0.05, 0, 0, 0.02, 0.3, 0, 0, 0.05])


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("[20 Hz, 21 Hz]", "[20, 20.5, 21]", "band = .*: must be least and greatest frequency"),
        ("restitution: 0.7", "restitution: 0.7, inclination: 100 deg", "damper.inclination = '100"),
        ("restitution: 0.7", "restitution: 0.7, inclination: 30 deg, normal_force: 2 N", None),
        ("band:", "frequencies: 9\nband:", None),
        ("band:", "absorber: {mass: 1, damping: 9}\nband:", "absorber.stiffness: missing"),
        ("band:", "absorber: {mass: 1, damping: 9, stiffness: 1e4}\nband:", None),
        ("linear_stiffness: 2e5 N/m", "natural_frequency: 20.5 Hz", None),
        ("damping_ratio: 5 %", "quality_factor: 10", None),
    ],
)
def test_other_keys_of_a_file(machine_file, before, after, told):
    machine_file.write_text(FILE.replace(before, after))
    if told is None:
        assert read_machine_file(machine_file)
    else:
        with pytest.raises(ConfigurationError, match=told):
            read_machine_file(machine_file)


def test_numbers_with_an_exponent_are_numbers(machine_file):
    """YAML 1.1 takes 2e5 for text."""
    machine_file.write_text(FILE.replace("2e5 N/m", "2e5").replace("2e6 N/m", ".2E+7"))
    given = read_machine_file(machine_file)
    assert given["machine"]["linear_stiffness"] == 2e5
    assert given["damper"]["contact_stiffness"] == 2e6


def test_error_ends_the_command_with_one_message(machine_file, monkeypatch):
    """The command prints the message of the library, in SI units and without a traceback."""
    arguments = ["impact-damper", "simulate", str(machine_file), "--frequency", "24 kg"]
    monkeypatch.setattr(sys, "argv", arguments)
    with pytest.raises(SystemExit, match="Error: frequency = '24 kg'"):
        command_line.run_app()


def test_a_file_that_is_no_design_gets_no_page(machine_file, tmp_path):
    motion = tmp_path / "motion.nc"
    run("simulate", machine_file, "--frequency", 20, "--periods", 3, "--output", motion)
    assert "must be of a design or an evaluation" in str(refused("report", motion))
    assert "is not a" in str(refused("report", machine_file))


def test_ctrl_c_ends_with_its_code_and_what_to_do(machine_file, monkeypatch, capsys):
    monkeypatch.setattr(command_line, "read", Mock(side_effect=KeyboardInterrupt))
    monkeypatch.setattr(sys, "argv", ["impact-damper", "design", str(machine_file)])
    with pytest.raises(SystemExit) as ended:
        command_line.run_app()
    assert ended.value.code == command_line.INTERRUPTED
    assert "the same command continues the design" in capsys.readouterr().err


def test_the_help_holds_a_file_that_works(tmp_path):
    """The example in the help is a complete file, so that a new user can begin with it."""
    lines = [line.strip() for line in run("--help").splitlines()]
    keys = ("machine:", "damper:", "band:")
    (tmp_path / "machine.yaml").write_text("\n".join(x for x in lines if x.startswith(keys)))
    assert any("harmonic excitation of one mode" in line for line in lines)
    assert read_machine_file(tmp_path / "machine.yaml").keys() > {"machine", "damper", "band"}


# A program without the packages that only the paper and the command line need.
BLOCKED = """
import sys

class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {blocked}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Absent())
import impact_damper as idm
from impact_damper.command import run

for name in idm.__all__:
    getattr(idm, name)
idm.plot.response(idm.harmonic_balance(idm.Oscillator(0.2), None, [1.0, 2.0]))
run()
"""


def test_the_library_needs_only_its_own_packages():
    """Without further packages all names load, and the command says what to install."""
    blocked = ("chatterjee1995", "jinja2", "pydantic", "snakemake", "typer", "yaml")
    code = BLOCKED.format(blocked=blocked)
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert told.returncode == 1 and "Error: the command needs the package" in told.stderr
    assert "pip install 'impact-damper[command]'" in told.stderr
