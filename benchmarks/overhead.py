"""Share of a run of the pipeline that does not go into computing: start-up of jobs, idle cores."""

import re
import subprocess
import sys
import tempfile
import time
from datetime import datetime, timedelta
from pathlib import Path

import pandas as pd

from benchmarks import stages

REPEATS = 5
# An empty job: the imports that Snakemake puts before a script, and the imports of most scripts.
EMPTY = """
from pathlib import Path
from types import SimpleNamespace

from snakemake.iocontainers import Snakemake
from snakemake.logging import logger

import impact_damper.motions.response
from chatterjee1995.workflow.job import Job

log = Path(__file__).parent / "logs/empty.log"
log.parent.mkdir(exist_ok=True)
Job(SimpleNamespace(log=[log], output=["empty.nc"], params=[{}]))
"""


def last_run(folder):
    """Return Snakemake's log of the run with the most jobs, the newest such run, or None."""
    texts = [path.read_text() for path in sorted(folder.glob("*.snakemake.log"), reverse=True)]
    done = [(len(_rules(text)), text) for text in texts if "Elapsed time:" in text]
    return max(done, key=lambda found: found[0], default=(0, None))[1]


def table(text, timings):
    """Return the core seconds of a run: for computing, for the start-up of jobs, and without a job.

    Parameters
    ----------
    text : str
        Snakemake's log of the run.
    timings : Path
        Folder of the timings of jobs; files written before the run are ignored.
    """
    begin = datetime.fromisoformat(re.search(r"Date: (.*)", text)[1])
    clock = datetime.strptime(re.search(r"Elapsed time: ([\d:.]+)", text)[1], "%H:%M:%S.%f")
    wall = timedelta(hours=clock.hour, minutes=clock.minute, seconds=clock.second).total_seconds()
    cores = int(re.search(r"Provided cores: (\d+)", text)[1])
    found = stages.jobs(timings, since=begin.timestamp())
    start_up = len(found) * start_up_of_a_job()
    computing = found["seconds"].sum() - start_up
    rows = {
        "jobs": len(found),
        "wall seconds": wall,
        "cores": cores,
        "core seconds": wall * cores,
        "computing": computing,
        "start-up of jobs": start_up,
        "without a job": wall * cores - found["seconds"].sum(),
        "overhead, per cent": 100 * (1 - computing / (wall * cores)),
    }
    return pd.DataFrame({"what": rows.keys(), "value": rows.values()})


def start_up_of_a_job():
    """Return the seconds of a job that computes nothing."""
    with tempfile.TemporaryDirectory(prefix="impact-damper-") as folder:
        script = Path(folder) / "empty.py"
        script.write_text(EMPTY)
        begin = time.perf_counter()
        for _ in range(REPEATS):
            subprocess.run([sys.executable, script], check=True)
        return (time.perf_counter() - begin) / REPEATS


def _rules(text):
    """Return the rule of each job that ended."""
    return re.findall(r"^Finished jobid: \d+ \(Rule: (\w+)\)", text, re.MULTILINE)
