"""Time and missed contacts of other programs, beside the kernel, at equal error.

A program that is not installed is left out, with a line that says what it needs.
"""

import math
from functools import partial

import numpy as np
import pandas as pd
from references import extended

from benchmarks.methods import ensemble, single
from benchmarks.rivals import cvode_runs, diffrax_runs, odeint_runs
from benchmarks.timing import interleaved, spread

LIMIT = 1e-9
# Two tolerances per decade, from 1e-6 to 3e-14, the tightest tolerance that the programs accept.
TOLERANCES = 10.0 ** (-np.arange(12, 28) / 2)
PROGRAMS = {
    "Boost.odeint, dopri5": odeint_runs,
    "CVODE, Adams": cvode_runs,
    "diffrax, Dopri8": diffrax_runs,
}
HOW = (
    "Each program has the loosest tolerance that keeps the error of the state at the end, against "
    f"80-bit arithmetic, below {LIMIT:g}, or else the tightest tolerance. `missed` counts contacts "
    "of all starts. `kernel_faster` is the time of the program divided by the time of the kernel "
    "for the same starts, the median over rounds. Beside diffrax, which runs all starts together, "
    "the kernel runs an ensemble, beside the others one start after the other."
)


def available():
    """Return the programs that can run here, and print what the other programs need."""
    found = {}
    for title, program in PROGRAMS.items():
        if obstacle := program.obstacle():
            print(f"  {title} is left out: {obstacle}", flush=True)
        else:
            found[title] = program
    return found


def table(scenes, rounds):
    """Return the table of times and missed contacts, by scene and program."""
    programs = available().items()
    rows = [_row(scene, *program, rounds) for scene in scenes for program in programs]
    return pd.DataFrame(rows)


def contacts_of(scene):
    """Return the exact number of contacts of all starts together."""
    return sum(
        extended.run(scene.parameters, start, scene.begin, scene.end, room=10_000).begun
        for start in scene.starts
    )


def _row(scene, title, program, rounds):
    """Return the row of one program on one scene."""
    for tolerance in TOLERANCES:
        run = program.prepare(scene, tolerance)
        states, contacts = run(scene.starts)
        error = scene.error(states)
        if error <= LIMIT:
            break
    ours = (ensemble if program is diffrax_runs else single)(scene, LIMIT / 10)
    calls = {"ours": partial(ours, scene.starts), "theirs": partial(run, scene.starts)}
    seconds = interleaved(calls, rounds)
    faster = spread("kernel_faster", seconds["theirs"] / seconds["ours"])
    cycles = len(scene.starts) * scene.periods
    exact = contacts_of(scene) if scene.components == 4 else 0
    print(f"  {scene.name}, {title}: error {error:.1e}", flush=True)
    return {
        "scene": scene.name,
        "program": title,
        "version": program.version(),
        "tolerance": tolerance,
        "error": error if math.isfinite(error) else math.nan,
        "within_limit": "yes" if error <= LIMIT else "no",
        "contacts": exact,
        "missed": exact - int(contacts.sum()),
        "kernel_error": scene.error(ours(scene.starts)),
        "microseconds": 1e6 * np.median(seconds["theirs"]) / cycles,
    } | faster
