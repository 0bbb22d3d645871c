"""A job of the workflow: its log, its end, its timing, and its parameters as objects.

Every script of `workflow/scripts/` first makes a `Job` from the variable `snakemake`, which
Snakemake defines. Scripts import this module before all others, because it makes garbage collection
rarer, which speeds up the other imports.
"""

import atexit
import gc
import os
import resource
import sys
import threading
import time
from collections import ChainMap
from contextlib import suppress
from functools import cached_property
from pathlib import Path

# Collect garbage only after 10 000 new objects, more than by default: objects made by imports stay
# until the end, and a job makes few others.
gc.set_threshold(10_000)

# Seconds between checks that Snakemake is alive. A new run of Snakemake needs longer than this to
# start its first job, so that jobs of an old run never meet jobs of a new one.
LOOK = 0.5
# Units of `ru_maxrss` in a megabyte: bytes on macOS, kilobytes elsewhere.
MEGABYTE = 2**20 if sys.platform == "darwin" else 2**10


class Entry:
    """Parameters of one entry of the configuration, as objects of the package.

    Parameters
    ----------
    given : mapping
        Parameters keyed by name, as returned by `Stage.parameters` of the registry.
    output : str
        File of the dataset.
    """

    def __init__(self, given, output):
        self.given, self.output = given, output

    def __getitem__(self, key):
        return self.given[key]

    @property
    def oscillator(self):
        """The oscillator, a `system.parameters.Oscillator`."""
        from impact_damper.model.parameters import Oscillator

        return Oscillator(**self["oscillator"])

    @property
    def damper(self):
        """The damper, or None.

        The clearance `rule` is replaced by the value of equation (19) of the paper.
        """
        from impact_damper.model.parameters import Damper
        from impact_damper.theory.design_rule import rule_clearance

        given = self["damper"]
        if given is None:
            return None
        if given["clearance"] == "rule":
            given = given | {"clearance": rule_clearance(self.oscillator, given["mass_ratio"])}
        return Damper(**given)

    @property
    def settling(self):
        """Length and accuracy of runs, a `system.settling.Settling`."""
        from impact_damper.model.settling import Settling

        return Settling(**self["settling"])

    def grid(self, key):
        """Return evenly spaced values of a range given as first, last and count."""
        import numpy as np

        return np.linspace(*self[key])

    def powers(self, key):
        """Return values with a constant ratio, of a range given as first, last and count."""
        import numpy as np

        return np.geomspace(*self[key])

    def counts(self, key):
        """Return the values of `powers` rounded to whole numbers."""
        return [int(value) for value in self.powers(key).round()]

    def save(self, data):
        """Write a dataset to the output."""
        from impact_damper.data.datasets import save

        save(data, self.output)


class Job(Entry):
    """A job that Snakemake has started.

    Creating the object redirects all output to the log, and makes the process end soon after
    Snakemake ends. An error about a file is reported in one line, in the log and on the terminal,
    since on a full disk the log stays empty. When the job ends, its time and memory are written
    into the folder `timings`, at the same relative path as its log in the folder `logs`.

    Parameters
    ----------
    snakemake : object
        The variable `snakemake` of a script.
    """

    def __init__(self, snakemake):
        super().__init__(ChainMap(*snakemake.params), snakemake.output[0])
        self.snakemake = snakemake
        log = Path(snakemake.log[0])
        depth = log.parts[::-1].index("logs")
        self.results = log.parents[depth]
        end_with_parent()
        _report_file_errors()
        sys.stdout = sys.stderr = open(log, "w", buffering=1)
        timing = self.results / "timings" / log.relative_to(self.results / "logs")
        atexit.register(_write_timing, timing.with_suffix(".tsv"))
        atexit.register(gc.freeze)  # avoids a last garbage collection at the end of the process

    @property
    def running(self):
        """Keywords `workers` and `progress` for functions that use threads."""
        return {"workers": self.snakemake.threads, "progress": self["name"]}

    def entries(self):
        """Yield the entries of a job that computes several; their files lie side by side."""
        for name, given in self.given.items():
            path = Path(self.output).with_name(f"{name}.nc")
            yield Entry(given, path)

    @cached_property
    def datasets(self):
        """All datasets among the inputs, keyed by stage and by name of the entry."""
        from impact_damper.data.datasets import load

        found = {}
        for path in map(Path, self.snakemake.input):
            if path.suffix == ".nc":
                found.setdefault(path.parent.name, {})[path.stem] = load(path)
        return found


def _report_file_errors():
    """Report errors about files in one line, on the terminal and in the log."""
    terminal, show = sys.stderr, sys.excepthook

    def report(kind, error, trace):
        # On a full disk, closing the file of a figure may raise a second error that hides the
        # first.
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
    """End this process soon after the process that started it has ended.

    Otherwise a job would continue after Snakemake was killed, and could overwrite the results of a
    newer run with results of an older configuration.
    """
    threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()


def _end_with(parent):
    """Wait until the process with the id `parent` is no longer the parent, then end."""
    while os.getppid() == parent:
        time.sleep(LOOK)
    os._exit(1)


def _write_timing(path):
    """Write seconds, CPU seconds and peak memory (MB) of this process and its children."""
    import psutil

    process = psutil.Process()
    seconds = time.time() - process.create_time()
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    cpu = sum(each.ru_utime + each.ru_stime for each in used)
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        numbers = "\t".join(f"{value:.3f}" for value in (seconds, cpu, peak_memory()))
        path.write_text(f"seconds\tcpu_seconds\tpeak_memory_mb\n{numbers}\n")


def peak_memory() -> float:
    """Return the peak memory in MB of this process, or of a child process that needed more.

    On Linux `ru_maxrss` of a new process starts at the value of its parent, here Snakemake. On
    Linux the peak of this process is therefore read from `/proc`.
    """
    own, children = resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN
    peak, largest_child = (resource.getrusage(who).ru_maxrss / MEGABYTE for who in (own, children))
    status = Path("/proc/self/status")
    if status.exists():
        lines = status.read_text().splitlines()
        (peak,) = (int(line.split()[1]) / 2**10 for line in lines if line.startswith("VmHWM:"))
    return max(peak, largest_child)
