"""Seconds of each step of a design, and the step's share of all seconds, in one run."""

import resource
import tempfile
import time
from pathlib import Path

import pandas as pd

import impact_damper as idm

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005, "force": 40}
# Machine, band (Hz) and loose mass (kg) of each design.
DESIGNS = {
    "linear": (SPRING, (20.3, 20.8), 0.6),
    "hardening": (SPRING | {"cubic_stiffness": 4e9}, (26, 34), 0.6),
}
HOW = (
    "Each step keeps its result in a file; its seconds are the time between this file and the file "
    "before. Other processes on the computer lengthen all steps alike. The shares of the steps and "
    "the CPU seconds of a whole design depend less on other processes."
)


def cpu_seconds():
    """Return the CPU seconds of this process so far."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def steps_of(name, size, share, workers):
    """Return the seconds of each step of a design, keyed by step, and the design's CPU seconds."""
    machine, band, mass = DESIGNS[name]
    with tempfile.TemporaryDirectory() as folder:
        begin, used = time.time(), cpu_seconds()
        idm.design_damper(
            idm.Machine(**machine),
            mass=mass,
            band=band,
            restitution=0.7,
            contact=2e7,
            share=share,
            effort=idm.Effort(**size, workers=workers),
            folder=folder,
        )
        used = cpu_seconds() - used
        ends = sorted((path.stat().st_mtime, path.stem) for path in Path(folder).glob("*.nc"))
    seconds = {}
    for end, step in ends:
        seconds[step], begin = end - begin, end
    return seconds, used


def table(size, share=0.95, workers=2):
    """Return the seconds and the share of each step of all designs.

    `size` are arguments of `Effort`. `share` is an argument of `design_damper`.
    """
    # A small design first, which loads all modules and kernels.
    steps_of("linear", {"frequencies": 3, "candidates": 4, "starts": 16}, 0.8, 1)
    rows = []
    for name in DESIGNS:
        seconds, used = steps_of(name, size, share, workers)
        whole = sum(seconds.values())
        print(f"  {name}: {whole:.1f} s, {used:.1f} CPU s", flush=True)
        for step, value in seconds.items():
            print(f"    {step}: {value:.2f} s, {value / whole:.0%}", flush=True)
            rows.append({"design": name, "step": step, "seconds": value, "share": value / whole})
        rows.append({"design": name, "step": "all", "seconds": whole, "share": 1.0})
        rows.append({"design": name, "step": "all, CPU", "seconds": used, "share": used / whole})
    return pd.DataFrame(rows)
