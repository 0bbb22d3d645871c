"""After an edit exactly those jobs run again that depend on it.

The whole workflow is asked, with results that were only touched. What the rules say of their jobs
is compared with the flow of data for every value of the configuration and every source file; dry
runs of Snakemake show that it plans what the rules say.
"""

import copy
import json
import re
from base64 import b64decode

import pytest
import yaml
from helpers.data_flow import DRAWN
from helpers.following import Flow
from helpers.planning import Planner, name_of, reruns
from helpers.running import ROOT, copy_of_project, snakemake
from netCDF4 import Dataset

from impact_damper.workflow.configuration import ConfigurationError, check_configuration


def leaves(value, path=()):
    """Keys that lead to each value of the configuration that holds no others."""
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from leaves(part, (*path, key))
    else:
        yield path


def at(config, path):
    for key in path:
        config = config[key]
    return config


def changed(config, path):
    """The configuration with another value, or None where no other is allowed by itself."""
    config = copy.deepcopy(config)
    *inner, key = path
    place, value = at(config, inner), at(config, path)
    if inner[-1:] == ["stages"] or (inner[-1:] == ["data"] and len(place) > 1):
        del place[key]
        # A figure draws a stage that its curves must have.
        try:
            check_configuration(config)
        except ConfigurationError:
            return None
    elif isinstance(value, str):
        place[key] = other(config, path, value)
        if place[key] is None:
            return None
    else:
        place[key] = value + 1 if isinstance(value, int) else 1.01 * value
    return config


def other(config, path, value):
    """Another text that is allowed in place of a text."""
    key = path[-1]
    if key in ("title", "remark", "results"):
        return f"{value}-again"
    if path[0] == "figures":
        figure = config["figures"][path[1]]
        section = DRAWN.get(figure["kind"], figure["kind"])
        if key == "kind":
            kinds = DRAWN | {"migration": "migration"}
            choices = [kind for kind, drawn in kinds.items() if drawn == section]
        else:
            choices = config.get(section, ["elastic_model", "inelastic_model"])
    else:
        choices = {
            "oscillator": config["oscillators"],
            "scene": ["design", "many_contacts"],
            "clearance": [1.5],
            "parameter": ["mass_ratio", "damping"],
            "motion": ["steady", "transient"],
            "quantity": ["amplitude", "state"],
        }[key]
    return next((choice for choice in choices if choice != value), None)


def sources(project):
    """Files of the project on which results may depend."""
    folders = ("src", "workflow", "profiles", "config")
    found = [path for folder in folders for path in (project / folder).rglob("*.*")]
    found += [project / "Snakefile", project / "requirements.lock"]
    return {
        path.relative_to(project).as_posix() for path in found if "__pycache__" not in str(path)
    }


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """The whole project after a run to its end, in which every result is empty."""
    project = copy_of_project(tmp_path_factory.mktemp("a project"))
    path = project / "config/config.yaml"
    # so that `settling.scene` can be changed by itself
    text = path.read_text()
    path.write_text(text.replace("\n  design:\n", "\n  design:\n    tolerance: 1.0e-5\n"))
    told = snakemake(project, "--summary")
    for line in told.stdout.splitlines()[1:]:
        output = project / line.split("\t")[0]
        output.parent.mkdir(parents=True, exist_ok=True)
        with Dataset(output, "w") if output.suffix == ".nc" else output.open("w"):
            pass
    result = snakemake(project, "--touch", "--forceall")
    assert result.returncode == 0, result.stdout + result.stderr
    return project


@pytest.fixture(scope="module")
def config(project):
    return yaml.safe_load((project / "config/config.yaml").read_text())


@pytest.fixture(scope="module")
def planner():
    return Planner(ROOT)


@pytest.fixture(scope="module")
def jobs(planner, config):
    return planner.jobs(config)


@pytest.fixture(scope="module")
def flow(project, config):
    return Flow(project, config)


def recorded(project):
    """What Snakemake noted of each output: its job's parameters and inputs."""
    for path in (project / ".snakemake/metadata").iterdir():
        record = json.loads(path.read_text())
        name = name_of(b64decode(path.name).decode())
        yield name, frozenset(record["params"]), frozenset(record["input"])


def to_do(project):
    """Jobs that Snakemake would run, by its own summary of the outputs."""
    result = snakemake(project, "--summary")
    assert result.returncode == 0, result.stdout + result.stderr
    lines = [line.split("\t") for line in result.stdout.splitlines()[1:]]
    return {name_of(line[0]) for line in lines if line[-1] != "no update"}


@pytest.fixture
def edit(project):
    """Edit a file of the project, until the test ends."""
    originals = {}

    def change(name, text):
        path = project / name
        originals.setdefault(path, path.read_text())
        path.write_text(text)

    yield change
    for path, text in originals.items():
        path.write_text(text)


def test_rules_say_what_snakemake_notes(project, jobs):
    noted = list(recorded(project))
    assert {name for name, *_ in noted} - {"kernels", "rival_kernels"} == set(jobs)
    for name, params, inputs in noted:
        if name in jobs:
            assert (params, inputs) == jobs[name][:2], name


def test_each_value_reruns_what_depends_on_it(planner, jobs, flow, config):
    wrong = {}
    for path in leaves(config):
        edited = changed(config, path)
        if edited is None or path in (("results",), ("chunks",)):
            continue
        found, expected = reruns(jobs, planner.jobs(edited)), flow.of(path)
        if found != expected:
            wrong[path] = {"needless": found - expected, "missing": expected - found}
    assert not wrong


def test_each_source_reruns_what_depends_on_it(jobs, flow):
    wrong = {}
    for path in sources(ROOT):
        found, expected = reruns(jobs, jobs, {path}), flow.of_file(ROOT, path)
        if found != expected:
            wrong[path] = {"needless": found - expected, "missing": expected - found}
    assert not wrong


VALUES = [
    ("results",),
    ("settling", "scene"),
    ("oscillators", "h107", "frequencies", "last"),
    ("curves", "figure_08", "clearance"),
    ("curves", "figure_05b", "stages", 2),
    ("figures", "figure_10", "data", 0),
    ("figures", "figure_14", "kind"),
    ("figures", "figure_08", "title"),
]


@pytest.mark.parametrize("path", VALUES, ids=lambda path: ".".join(map(str, path)))
def test_snakemake_reruns_what_depends_on_a_value(path, project, edit, flow, config):
    edit("config/config.yaml", yaml.safe_dump(changed(config, path), sort_keys=False))
    everything = {"kernels", "rival_kernels"} | flow.of(path)
    assert to_do(project) == (everything if path == ("results",) else flow.of(path))


FILES = [
    "requirements.lock",
    "src/impact_damper/kernel/single.py",
    "src/impact_damper/figures/style.py",
    "workflow/report/response.rst",
]


@pytest.mark.parametrize("path", FILES)
def test_snakemake_reruns_what_depends_on_a_file(path, project, edit, flow):
    edit(path, (project / path).read_text() + "\n")
    assert to_do(project) == flow.of_file(project, path)


def test_another_number_of_chunks_computes_studies_anew(project, edit, config):
    edited = changed(config, ("chunks",))
    edit("config/config.yaml", yaml.safe_dump(edited))
    assert to_do(project) == Flow(project, edited).of(("chunks",))


def test_a_lost_chunk_costs_itself(project, flow):
    chunk = project / "results/study_chunks/design_plane/2-of-4.nc"
    study = project / "results/studies/design_plane.nc"
    kept = {path: path.read_bytes() for path in (chunk, study)}
    chunk.unlink()
    gathered = snakemake(project, "-n", "studies")
    study.unlink()
    plan = snakemake(project, "-n", "studies")
    for path, content in kept.items():
        path.write_bytes(content)
    assert "Nothing to be done" in gathered.stdout + gathered.stderr
    assert re.findall(r"^Job \d+: (.*)$", plan.stdout, re.M) == [
        "Chunk 2-of-4 of the study design_plane",
        "Gathering the study design_plane",
    ]


def test_a_figure_style_computes_nothing(flow):
    plan = flow.of_file(ROOT, "src/impact_damper/figures/style.py")
    assert plan == {job for job in flow.needs if job.startswith("figures/")}


def test_touched_files_comments_and_order_rerun_nothing(project, edit, config):
    for part in ("src", "workflow", "config"):
        for path in (project / part).rglob("*.*"):
            path.touch()

    def turned(value):
        if not isinstance(value, dict):
            return value
        return {key: turned(part) for key, part in reversed(value.items())}

    text = yaml.safe_dump(turned(config), sort_keys=False)
    edit("config/config.yaml", f"# A word.\n{text}")
    (project / "results/kernels.compiled").unlink()
    result = snakemake(project, "-n")
    (project / "results/kernels.compiled").touch()
    assert "Nothing to be done" in result.stdout + result.stderr


def test_a_dry_run_says_what_changed(project, edit, config):
    edited = copy.deepcopy(config)
    edited["curves"]["figure_08"]["clearance"] = 1.07
    edit("config/config.yaml", yaml.safe_dump(edited))
    result = snakemake(project, "-n")
    told = result.stdout + result.stderr
    # nothing but the damper stands between the two words
    was, is_now = re.search(
        r"Motions with the damper over frequency, of the curve figure_08\n"
        r"Reason: Params have changed .* before: (.*) now: (.*)",
        told,
    ).groups()
    assert yaml.safe_load(was) == {"damper": damper(1.063)}
    assert yaml.safe_load(is_now) == {"damper": damper(1.07)}
    edit("workflow/scripts/steady_motion.py", "# A word.")
    told = snakemake(project, "-n", "results/motion/figure_04.nc").stdout
    assert "Reason: Updated input files: workflow/scripts/steady_motion.py" in told


def damper(clearance):
    return {
        "mass_ratio": 0.12,
        "clearance": clearance,
        "restitution": 1,
        "contact_stiffness": 2000,
    }
