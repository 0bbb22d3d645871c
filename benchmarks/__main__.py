"""Run all benchmarks, one after the other; `--quick` only tries whether the scripts run."""

import argparse
import time
from pathlib import Path

from benchmarks import (
    basins,
    chart,
    costs,
    design,
    machine,
    orbits,
    overhead,
    promises,
    ratios,
    scaling,
    scenes,
    searches,
    settled,
    stages,
    startup,
)
from benchmarks.rivals import table as rivals
from benchmarks.timing import one_core
from chatterjee1995.tables import files as table_files
from impact_damper.plot import style

# Amounts of work. FULL is for results, QUICK is as little as possible, to try the scripts.
FULL = {"starts": 16, "rounds": 15, "few": 5, "exponents": range(3, 14), "motions": 24,
        "sizes": (1, 16, 64, 256, 1024), "shared": 65536, "wide": 1000, "random": 40,
        "settled": 2000, "drawn": 10,
        "design": ({"frequencies": 41, "candidates": 12, "starts": 96}, 0.95)}  # fmt: skip
QUICK = {"starts": 16, "rounds": 3, "few": 1, "exponents": (5, 9), "motions": 2,
         "sizes": (1, 16), "shared": 256, "wide": 20, "random": 1, "settled": 64,
         "drawn": 0,
         "design": ({"frequencies": 3, "candidates": 4, "starts": 16}, 0.8)}  # fmt: skip
RUN_FIRST = "no timings of the pipeline in {}: run `make reproduce` first"


def compare(write, amount):
    """Compare the kernel with other integrators on all scenes (test cases)."""
    found = scenes.from_configuration(amount["starts"])
    with one_core():
        times, made = ratios.compared(found, amount["rounds"])
        write("times", times)
        write("ratios", made, how=ratios.HOW)
        write("heyoka_settings", ratios.heyoka_settings(found, times, amount["rounds"]))


def compare_programs(write, amount):
    """Compare the kernel with odeint, CVODE and diffrax."""
    found = scenes.from_configuration(amount["starts"])
    with one_core():
        write("rivals", rivals.table(found, amount["few"]), how=rivals.HOW)


def draw_chart(write, amount):
    """Chart the error of each integrator against its time."""
    found = scenes.from_configuration(amount["starts"])
    with one_core():
        table = chart.points(found, amount["exponents"], amount["few"])
    write("error_against_time", table, chart.draw(table))


def cost(write, amount):
    """Measure the time that the kernel takes for a forcing cycle."""
    with one_core():
        table = costs.per_period(costs.motions(amount["motions"]), amount["few"])
    write("period_cost", table, costs.draw(table))
    write("period_cost_fit", costs.fitted(table))


def scale(write, amount):
    """Measure the speed of ensembles (trajectories computed together) over size and cores."""
    found = scenes.from_configuration(amount["starts"])
    chosen = [scene for scene in found if scene.name in ("design", "resonance")]
    with one_core():
        write("ensemble_sizes", scaling.sizes(chosen, amount["sizes"], amount["few"]))
    write("ensemble_cores", scaling.cores(chosen, amount["shared"], amount["rounds"]))


def start(write, amount):
    """Measure the times of start-up and compilation."""
    write("start_up", startup.table(amount["few"], compiling=amount is FULL))


def search(write, amount):
    """Compare the default search for motions with a search that is ten times as wide."""
    systems = [*searches.named_systems(), *searches.random_systems(amount["random"])]
    write("searches", searches.table(systems, amount["wide"]))


def time_designs(write, amount):
    """Measure the times of the steps of designs."""
    write("design", design.table(*amount["design"]), how=design.HOW)


def keep_promises(write, amount):
    """Check the promises of designs by another program."""
    write("promises", promises.table(amount["drawn"], workers=2), how=promises.HOW)


def settle(write, amount):
    """Count per second the starts settled, the states of a plane labelled, and the orbits found."""
    with one_core():
        write("settled", settled.table(amount["settled"], amount["few"]))
        write("basins", basins.table(50 * amount["settled"], amount["few"]))
        write("orbits", orbits.table(amount["settled"] // 20, amount["few"]))


PARTS = {
    "ratios": compare,
    "rivals": compare_programs,
    "chart": draw_chart,
    "costs": cost,
    "scaling": scale,
    "start_up": start,
    "searches": search,
    "settled": settle,
    "design": time_designs,
    "promises": keep_promises,
}


def main():
    reader = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    reader.add_argument("parts", nargs="*", help=f"any of {', '.join(PARTS)}, stages; default: all")
    reader.add_argument("--quick", action="store_true", help="as little work as possible")
    reader.add_argument("--results", type=Path, default=Path("results"), help="folder of results")
    given = reader.parse_args()
    parts = given.parts or [*PARTS, "stages"]
    if unknown := set(parts) - {*PARTS, "stages"}:
        reader.error(f"unknown: {', '.join(sorted(unknown))}")
    into = given.results / "benchmarks"

    def write(name, table, drawing=None, how=""):
        document = machine.document(how)
        table_files.save_table(table, into / f"{name}.csv", into / f"{name}.md", document)
        if drawing is not None:
            style.save_figure(drawing, into / name)

    begin = time.perf_counter()
    for name in parts:
        print(f"{name} (after {time.perf_counter() - begin:.0f} s)", flush=True)
        if name != "stages":
            PARTS[name](write, QUICK if given.quick else FULL)
            continue
        timings = given.results / "timings"
        table = stages.table(timings)
        if table.empty:
            print(f"  {RUN_FIRST.format(timings)}", flush=True)
        write("stages", table)
        log = overhead.last_run(Path(".snakemake/log"))
        if log and not table.empty:
            write("overhead", overhead.table(log, timings))
    print(f"{into} made in {time.perf_counter() - begin:.0f} s")


main()
