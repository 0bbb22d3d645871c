"""A small copy of the project, its runs, and the comparison with an undisturbed run."""

import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
# The package itself is not copied: numba's cache depends on the path of the sources, and compiling
# again would take minutes.
PARTS = ["Snakefile", "requirements.lock", "config", "profiles", "workflow"]
# The dataset that trials damage or remove.
DATA = "results/optimum/h215_rm012.nc"
TARGETS = [
    DATA,
    "results/harmonic_balance/figure_05a.nc",
    "results/tables/optimum.csv",
    "results/figures/figure_06.png",
]
CONFIGURATIONS = ["config/smoke.yaml", "config/small.yaml"]
CORES = 2
# Endings of the files that must be equal after a fault.
KINDS = {".nc", ".csv", ".md", ".png", ".pdf", ".rst"}
# Parts of messages: LOCKED of Snakemake about a folder, DELETE of the package about a damaged file.
LOCKED = "cannot be locked"
DELETE = "delete it and run the same command again"
# Processes that were started, to be killed at the end if they still run.
STARTED = []


def end_all():
    """Kill every run that has not ended."""
    for process in STARTED:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def job_of(path):
    """Return the name of the job that makes an output."""
    folder = Path(path).parent.name
    return "chapter" if folder in ("figures", "tables") else str(Path(path).with_suffix(""))


class Fault(AssertionError):
    """A trial failed; the message says why."""


def expect(holds, what):
    """Raise Fault with the message `what` unless `holds` is true."""
    if not holds:
        raise Fault(what)


class Project:
    """A copy of the project in another folder."""

    def __init__(self, folder, like=None):
        self.folder = folder
        if like:
            shutil.copytree(like.folder, folder, dirs_exist_ok=True)
            return
        folder.mkdir(parents=True, exist_ok=True)
        for part in PARTS:
            copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
            copy(ROOT / part, folder / part)
        shutil.copy(Path(__file__).with_name("small.yaml"), folder / CONFIGURATIONS[-1])

    def start(self, *arguments, targets=TARGETS):
        """Start the documented command as the leader of a new process group; return the process."""
        command = [sys.executable, "-m", "snakemake", "--cores", str(CORES), *targets]
        process = subprocess.Popen(
            [*command, "--configfile", *CONFIGURATIONS, *arguments],
            cwd=self.folder,
            env=os.environ | {"PYTHONPATH": str(ROOT / "src")},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        STARTED.append(process)
        return process

    def run(self, *arguments, **options):
        """Run the documented command; return its exit code and its output."""
        process = self.start(*arguments, **options)
        told, _ = process.communicate()
        return process.returncode, told

    def planned(self):
        """Return the messages of the jobs that a dry run plans."""
        code, told = self.run("-n")
        expect(code == 0, f"a dry run fails: {told[-500:]}")
        return re.findall(r"^Job \d+: (.*)$", told, re.M)

    def outputs(self):
        """Return the contents of all outputs that must not differ between runs, by path."""
        found = sorted((self.folder / "results").rglob("*"))
        return {
            str(path.relative_to(self.folder)): path.read_bytes()
            for path in found
            if path.suffix in KINDS
        }

    def written(self):
        """Return inode and time of modification of each output, by path."""
        return {
            path: (stat.st_ino, stat.st_mtime_ns)
            for path in self.outputs()
            for stat in [(self.folder / path).stat()]
        }

    def expect_only_whole(self, undisturbed):
        """Raise Fault if an output differs from the same output of the undisturbed run."""
        for path, content in self.outputs().items():
            expect(
                content == undisturbed.get(path),
                f"{path} is left, but differs from the undisturbed run",
            )

    def recover(self, undisturbed, lost=CORES):
        """Run the documented command again, and raise Fault unless the results become complete.

        At most `lost` jobs may run a second time. Returns what the user has to do: "run again" or
        "--unlock, run again".
        """
        self.expect_only_whole(undisturbed)
        before, took = self.written(), "run again"
        code, told = self.run()
        if code and LOCKED in told:
            expect("--unlock" in told, "the message about the lock does not name --unlock")
            took = "--unlock, run again"
            self.run("--unlock")
            code, told = self.run()
        expect(code == 0, f"the run does not recover: {told[-800:]}")
        after = self.written()
        # Not counted: files dated 1970, for the workflow sets dates in the future to this date.
        again = {
            job_of(path)
            for path in before
            if before[path] != after[path] and after[path][1] > 10**9
        }
        expect(len(again) <= lost, f"jobs that had finished ran again: {sorted(again)}")
        self.expect_same(undisturbed)
        return took

    def expect_same(self, undisturbed):
        """Raise Fault if outputs differ from an undisturbed run, or something is left to do."""
        found = self.outputs()
        differing = sorted(
            path for path in found.keys() | undisturbed if found.get(path) != undisturbed.get(path)
        )
        expect(not differing, f"files differ from the undisturbed run: {differing}")
        left = [path.name for path in (self.folder / "results").rglob("*.part-*")]
        expect(not left, f"unfinished files are left: {left}")
        expect(not self.planned(), "another run would run jobs again")
