"""Error against time: every method over its tolerances, on every scene.

A scene is a test case: one motion with starts (initial states) and exact states at its end. Rivals
are the integrators compared with the package. A rival either locates contacts or steps over them.
"""

import math
import time
from functools import partial

import numpy as np
import pandas as pd

from benchmarks.accuracy import measured
from benchmarks.methods import RIVALS, TIMED, applying, starts_of
from benchmarks.timing import interleaved
from chatterjee1995.methods.integrators import runs_of_accuracy
from chatterjee1995.methods.labels import colour_of
from impact_damper.plot import style

# Seconds. After a run that took longer, no tighter tolerance is tried.
LONG = 0.5
# Error of the state. A run with a larger error has lost the motion.
LOST = 0.1
# Colour, line and marker of the kernel and of heyoka.py. `looks` adds the rivals.
LOOK = {
    "kernel": (style.BLUE, "-", "o"),
    "kernel_12_15": (style.BLUE, "--", "4"),
    "kernel_24_30": (style.BLUE, ":", "*"),
    "kernel_ensemble": (style.SKY, "-", "s"),
    "heyoka": (style.BLACK, "-", "^"),
    "heyoka_batch": (style.GREY, "-", "v"),
}
MARKERS = "DP<>"


def looks():
    """Return colour, line and marker of each method; rivals that locate contacts get full lines."""
    rivals, markers = {}, {}
    for label in RIVALS:
        integrator, located = runs_of_accuracy()[label]
        marker = markers.setdefault(integrator.name, MARKERS[len(markers) % len(MARKERS)])
        rivals[label] = colour_of(integrator.name), "-" if located else ":", marker
    return LOOK | rivals


def points_of(scene, name, exponents, rounds):
    """Return rows of the table of `points` for one method, at tolerances 10^-exponent."""
    rows = []
    starts = starts_of(scene, name)
    for exponent in exponents:
        begin = time.perf_counter()
        run, error = measured(scene, name, 10.0**-exponent)
        seconds = time.perf_counter() - begin
        if not TIMED[name].slow:
            seconds = np.median(interleaved({"": partial(run, starts)}, rounds)[""])
        status = "found" if error <= LOST else "lost" if math.isfinite(error) else "given_up"
        rows.append({
            "scene": scene.name, "method": name, "tolerance": 10.0**-exponent,
            "error": error if math.isfinite(error) else math.nan, "status": status,
            "microseconds": 1e6 * seconds / (len(starts) * scene.periods),
        })  # fmt: skip
        if seconds > LONG:
            break
    return rows


def points(scenes, exponents, rounds, names=tuple(TIMED)):
    """Return state error and microseconds per forcing cycle, by scene, method and tolerance.

    The time is the median over `rounds`; a slow method runs only once. `status` is "found", "lost"
    (the error of the state exceeds LOST) or "given_up" (the run did not end).
    """
    rows = []
    for scene in scenes:
        for name in [each for each in applying(scene) if each in names]:
            coarse = exponents[::2] if TIMED[name].slow else exponents
            rows += points_of(scene, name, coarse, rounds)
        print(f"  {scene.name}: error against time of {len(applying(scene))} methods", flush=True)
    return pd.DataFrame(rows)


@style.context()
def draw(table):
    """Draw a panel for each scene, from the table of `points`."""
    names = list(dict.fromkeys(table["scene"]))
    columns = 2
    rows = math.ceil(len(names) / columns)
    drawn = style.figure("double", 1.6 + 2.5 * rows)
    panels = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    for axes, scene in zip(panels, names, strict=False):
        here = table[table["scene"] == scene]
        for name, (color, line, marker) in looks().items():
            of = here[here["method"] == name]
            found, lost = of[of["status"] == "found"], of[of["status"] != "found"]
            inside = {"markersize": 3.2, "markerfacecolor": color if line == "-" else "white"}
            look = {"color": color, "linestyle": line, "marker": marker} | inside
            axes.plot(found["microseconds"], found["error"], label=TIMED[name].title, **look)
            axes.plot(lost["microseconds"], np.ones(len(lost)), "x", color=color)
        axes.plot([], [], color=style.BLACK, linestyle="none", marker="x", label="failed")
        axes.axhline(LOST, color=style.GREY, linewidth=0.6)
        axes.set(xscale="log", yscale="log", ylim=(1e-14, 3.0))
        axes.text(
            0.98, 0.02, scene.replace("_", " "), transform=axes.transAxes, ha="right", va="bottom"
        )
    for axes in panels[len(names) :]:
        axes.set_visible(False)
    for axes in panels[::columns]:
        axes.set_ylabel("Error of the state at the end")
    for axes in panels[max(0, len(names) - columns) : len(names)]:
        axes.set_xlabel("Time per forcing cycle and trajectory (µs)")
        axes.tick_params(labelbottom=True)
    style.letter_panels(panels[: len(names)])
    style.legend(drawn, 3)
    return drawn
