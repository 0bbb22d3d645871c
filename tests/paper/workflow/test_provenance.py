"""`provenance.json` records versions, commit and configuration of a run completely."""

import shutil
import subprocess
from importlib.metadata import version

import pytest
from helpers.running import ROOT

from chatterjee1995.workflow.provenance import provenance


def git(folder, *arguments):
    name = ["-c", "user.name=A", "-c", "user.email=a@example.org"]
    command = ["git", "-C", folder, *name, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def project(tmp_path):
    shutil.copy(ROOT / "requirements.lock", tmp_path)
    return tmp_path


def test_digests_tell_configurations_by_value_and_lock_files_apart(project):
    before = provenance({"seed": 1, "chunks": 2}, project)
    assert before["versions"]["numpy"] == version("numpy")
    same, other = (provenance(each, project) for each in ({"chunks": 2, "seed": 1}, {"seed": 2}))
    assert same["configuration"] == before["configuration"] != other["configuration"]
    (project / "requirements.lock").write_text("numpy==1.0\n")
    assert provenance({}, project)["lock"] != before["lock"]


@pytest.mark.skipif(not shutil.which("git"), reason="git is not installed")
def test_the_commit_and_whether_files_were_changed_since(project, monkeypatch):
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(project.parent))
    made = provenance({}, project)
    assert (made["commit"], made["modified"]) == (None, None)
    git(project, "init", "--quiet")
    git(project, "add", "requirements.lock")
    git(project, "commit", "--quiet", "--message", "All")
    made = provenance({}, project)
    assert (made["commit"], made["modified"]) == (git(project, "rev-parse", "HEAD"), False)
    (project / "requirements.lock").write_text("")
    assert provenance({}, project)["modified"]
