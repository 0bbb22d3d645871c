"""What a run of the pipeline spends on anything but computing."""

import re
import resource
import subprocess
import sys
from collections import Counter
from datetime import datetime, timedelta
from pathlib import Path

import pandas as pd

from benchmarks import stages

ROOT = Path(__file__).parents[1]
SCRIPT = re.compile(r"^rule (\w+):(?:(?!^rule ).)*?scripts/(\w+)\.py", re.MULTILINE | re.DOTALL)
# Modules that a script looks up by name: one that stands for all of them.
LOOKED_UP = {"draw": "impact_damper.figures.response", "table": "impact_damper.tables"}


def last_run(folder):
    """Text of the newest of Snakemake's logs of a run with the most jobs, or None."""
    texts = [path.read_text() for path in sorted(folder.glob("*.snakemake.log"), reverse=True)]
    done = [(len(_rules(text)), text) for text in texts if "Elapsed time:" in text]
    return max(done, key=lambda found: found[0], default=(0, None))[1]


def table(text, timings):
    """Core seconds of a run: those of its jobs, their start-up, and those without a job.

    Parameters
    ----------
    text : str
        Snakemake's log of the run.
    timings : Path
        Folder of what the jobs took; what was written before the run is left out.
    """
    begin = datetime.fromisoformat(re.search(r"Date: (.*)", text)[1])
    clock = datetime.strptime(re.search(r"Elapsed time: ([\d:.]+)", text)[1], "%H:%M:%S.%f")
    wall = timedelta(hours=clock.hour, minutes=clock.minute, seconds=clock.second).total_seconds()
    cores = int(re.search(r"Provided cores: (\d+)", text)[1])
    found = stages.jobs(timings, since=begin.timestamp())
    scripts = {rule: script for path in sorted((ROOT / "workflow/rules").glob("*.smk"))
               for rule, script in SCRIPT.findall(path.read_text())}  # fmt: skip
    started = Counter(scripts.get(rule, "draw") for rule in _rules(text) if rule != "all")
    start_up = sum(count * start_up_of(script) for script, count in started.items())
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


def start_up_of(script):
    """Processor seconds until a script has imported what it needs."""
    lines = (ROOT / "workflow/scripts" / f"{script}.py").read_text().splitlines()
    code = "\n".join(line for line in lines if line.startswith(("import ", "from ")))
    code += f"\nimport {LOOKED_UP[script]}" if script in LOOKED_UP else ""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-c", code], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def _rules(text):
    """The rule of each job that ended."""
    return re.findall(r"^Finished jobid: \d+ \(Rule: (\w+)\)", text, re.MULTILINE)
