"""A job of the workflow. Scripts import this module first, so that later imports are faster."""

import atexit
import gc
import inspect
import json
import os
import shutil
import sys
import threading
import time
from collections import ChainMap
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from importlib import import_module
from operator import attrgetter
from pathlib import Path

import psutil

# Collect garbage rarely: objects of imported modules stay in use, and a job makes few others.
gc.set_threshold(10_000)

# A job checks every LOOK seconds that Snakemake is alive, and ends if it is not. In LOOK seconds
# Snakemake cannot start again and begin a new job, so jobs of an old and a new run never overlap.
LOOK = 0.5

# Key of a parameter such as {"linspace": [0.6, 2.6, 41]} -> function that makes its value.
MADE = {
    "Oscillator": "impact_damper.model.parameters:Oscillator",
    "Damper": "impact_damper.model.parameters:Damper",
    "Settling": "impact_damper.model.settling:Settling",
    "Machine": "impact_damper.model.machine:Machine",
    "HertzContact": "impact_damper.model.hertz:HertzContact",
    "Effort": "impact_damper.design.task:Effort",
    "linspace": "numpy:linspace",
    "geomspace": "numpy:geomspace",
    "counts": "chatterjee1995.workflow.job:counts",
    "ladder": "chatterjee1995.stages.harmonic_convergence:ladder",
    "loads": "chatterjee1995.stages.contact_model:spread_loads",
}


def imported(name):
    """Return the object with a name such as "numpy:linspace"."""
    module, path = name.split(":")
    return attrgetter(path)(import_module(module))


def made(value):
    """Return `value` with dicts such as {"linspace": [0, 1, 5]} replaced by what they describe."""
    if isinstance(value, list):
        return [made(each) for each in value]
    if not isinstance(value, dict):
        return value
    (name, *others) = value or [None]
    if name in MADE and not others:
        function, given = imported(MADE[name]), made(value[name])
        return function(**given) if isinstance(given, dict) else function(*given)
    return {key: made(each) for key, each in value.items()}


def counts(first, last, points):
    """Return `points` whole numbers from `first` to `last`, nearly in geometric progression."""
    import numpy as np

    return np.geomspace(first, last, points).round().astype(int).tolist()


class Job:
    """A job, given by the variable `snakemake` of its script. If Snakemake stops, the job ends."""

    def __init__(self, snakemake):
        self.snakemake = snakemake
        # Each parameter is a dictionary with one key, see `parameters` in `rules/common.smk`.
        self.given = ChainMap(*snakemake.params)
        log = Path(snakemake.log[0])
        depth = log.parts[::-1].index("logs")
        self.results = log.parents[depth]
        end_with_parent()
        _report_file_errors()
        sys.stdout = sys.stderr = open(log, "w", buffering=1)
        timing = self.results / "timings" / log.relative_to(self.results / "logs")
        atexit.register(_write_timing, timing.with_suffix(".tsv"))
        atexit.register(gc.freeze)  # avoids a last garbage collection at the end of the process

    def run(self):
        """Compute and save the dataset of each entry of the job."""
        from impact_damper.data.datasets import save

        for path in map(Path, self.snakemake.output):
            given = self.given.get(f"entry_{path.stem}", self.given)
            steps = path.with_suffix("") / "steps"
            data = self.computed(given, {"name": path.stem, "folder": steps, "progress": path.stem})
            save(data, path)
            # Finished steps of a design serve only to continue an interrupted job.
            shutil.rmtree(steps, ignore_errors=True)

    def computed(self, given, offered):
        """Call the function of the stage, and return the dataset.

        The function gets all parameters in `given`, and the contents of the input files. From the
        dict `offered` it gets each value whose key is the name of one of its arguments.
        """
        function = imported(self.given["function"])
        taken = inspect.signature(function).parameters
        offered = offered | {"workers": self.snakemake.threads}
        arguments = {key: value for key, value in offered.items() if key in taken}
        arguments |= {
            key: made(value) for key, value in given.items() if key not in ("function", "name")
        }
        for key, files in self.snakemake.input.items():
            if key not in ("code", "kernels"):
                arguments[key] = _content(files)
        if "effort" in arguments:
            arguments["effort"] = replace(arguments["effort"], workers=offered["workers"])
        system = [arguments.pop("system")] if "system" in arguments else []
        return function(*system, **arguments)

    @cached_property
    def datasets(self):
        """All input datasets, as a dict: stage -> dict of datasets by the name of an entry."""
        from impact_damper.data.datasets import load

        found = {}
        for path in map(Path, self.snakemake.input):
            if path.suffix == ".nc":
                found.setdefault(path.parent.name, {})[path.stem] = load(path).assign_attrs(
                    name=path.stem
                )
        return found


def _content(files):
    from impact_damper.data.datasets import load

    if isinstance(files, str):
        return json.loads(Path(files).read_text())
    return list(map(load, files))


def _report_file_errors():
    """Print file errors in the log and on the terminal, as a full disk may lose the log."""
    terminal, show = sys.stderr, sys.excepthook

    def report(kind, error, trace):
        # On a full disk, closing a figure's file may raise a second error that hides the first.
        cause = error
        while not isinstance(cause, OSError) and cause is not None:
            cause = cause.__cause__ or cause.__context__
        if cause is not error:
            with suppress(OSError):
                show(kind, error, trace)
        if cause is None:
            return
        from impact_damper.data.whole_files import DELETE, BrokenFileError

        advice = f": {DELETE}." if isinstance(cause, BrokenFileError) else ""
        for place in (terminal, sys.stderr):
            with suppress(OSError):
                print(f"Error: {cause}{advice}", file=place)

    sys.excepthook = report


def end_with_parent() -> None:
    """End this process soon after its parent, so that no old job writes into a new run."""
    parent = os.getppid()

    def watch():
        while os.getppid() == parent:
            time.sleep(LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _write_timing(path):
    process = psutil.Process()
    seconds = time.time() - process.create_time()
    cpu = sum(process.cpu_times()[:4])  # user and system time of this process and of its children
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        numbers = "\t".join(f"{value:.3f}" for value in (seconds, cpu, peak_memory()))
        path.write_text(f"seconds\tcpu_seconds\tpeak_memory_mb\n{numbers}\n")


def peak_memory() -> float:
    """Return the peak memory of this process in MB."""
    status = Path("/proc/self/status")
    if status.exists():
        lines = status.read_text().splitlines()
        return next(int(line.split()[1]) / 2**10 for line in lines if line.startswith("VmHWM:"))
    if sys.platform == "win32":
        return psutil.Process().memory_info().peak_wset / 2**20
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20  # in bytes on macOS
