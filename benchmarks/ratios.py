"""Speed of the kernel against heyoka.py and SciPy at equal error. The methods take turns.

The kernel is this package's compiled integrator. A scene is a test case: a motion with several
initial states.
"""

from functools import partial

import pandas as pd

from benchmarks.accuracy import LIMIT, loosest
from benchmarks.heyoka_runs import BATCH, SETTINGS
from benchmarks.methods import TIMED, heyoka, starts_of
from benchmarks.timing import interleaved, spread

# Methods with which each use of the kernel is compared.
RIVALS = {
    "kernel": ("heyoka", "DOP853_located"),
    "kernel_ensemble": ("heyoka", "heyoka_batch", "DOP853_located"),
}
HOW = (
    "Each method has the loosest tolerance that keeps the error of the state at the end, against "
    f"80-bit arithmetic, below {LIMIT:g} (`times.md`). Methods take turns on one core. The table "
    "lists medians and quartiles over rounds of the ratio of times for a trajectory. heyoka.py has "
    "its fastest settings (`heyoka_settings.md`), SciPy a compiled right-hand side."
)
COMPARED = ("kernel", "kernel_ensemble", "heyoka", "heyoka_batch", "DOP853_located")


def tolerances(scene, timed, limit):
    """Return for each method the loosest tolerance that keeps the limit, as `accuracy.Found`."""
    found = {}
    for name in timed:
        each = found[name] = loosest(scene, name, limit)
        missed = "" if each.met else ", limit not met"
        print(
            f"  {scene.name}, {TIMED[name].title}: tolerance {each.tolerance:.1e}, "
            f"error {each.error:.1e}{missed}",
            flush=True,
        )
    return found


def microseconds(scene, found, rounds):
    """Return microseconds per forcing cycle and trajectory, of each method in each round."""
    starts = {name: starts_of(scene, name) for name in found}
    calls = {name: partial(each.run, starts[name]) for name, each in found.items()}
    seconds = interleaved(calls, rounds)
    return {name: 1e6 * seconds[name] / (len(starts[name]) * scene.periods) for name in found}


def time_row(scene, name, found, measured):
    """Return a row of the table of times."""
    return {
        "scene": scene.name,
        "method": TIMED[name].title,
        "tolerance": found.tolerance,
        "error": found.error,
        "within_limit": "yes" if found.met else "no",
        "least_us": measured.min(),
    } | spread("median_us", measured)


def ratio_row(scene, name, rival, found, measured):
    """Return a row of the table of ratios."""
    faster = spread("times_faster", measured[rival] / measured[name])
    ours, other = TIMED[name].title, TIMED[rival].title
    print(f"  {scene.name}, {ours}, {other}: {faster['times_faster']:.4g} times faster", flush=True)
    equal = {"equal_error": "yes" if found[name].met and found[rival].met else "no"}
    return {"scene": scene.name, "ours": ours, "rival": other} | faster | equal


def compared(scenes, rounds, limit=LIMIT, timed=COMPARED):
    """Return two tables: times at equal error, and ratios of the times.

    `limit` is the largest error of a component of a state at the end, and `timed` names methods.
    Times are microseconds for a forcing cycle of a trajectory. A ratio is of times in one round.
    """
    times, ratios = [], []
    for scene in scenes:
        found = tolerances(scene, timed, limit)
        measured = microseconds(scene, found, rounds)
        times += [time_row(scene, name, found[name], measured[name]) for name in timed]
        ratios += [
            ratio_row(scene, name, rival, found, measured)
            for name, rivals in RIVALS.items()
            for rival in rivals
            if name in timed and rival in timed
        ]
    return pd.DataFrame(times), pd.DataFrame(ratios)


def heyoka_settings(scenes, times, rounds):
    """Return how much slower heyoka.py is if one of its fastest settings is changed, by scene.

    The tolerances come from the table `times` of `compared`.
    """
    rows = []
    for scene in scenes:
        chosen = times[(times["scene"] == scene.name) & (times["method"] == TIMED["heyoka"].title)]
        tolerance = float(chosen["tolerance"].iloc[0])
        changes = {"fastest": {}} | SETTINGS
        changes |= {f"batch of {n}": {"batch": n} for n in (4, 8, BATCH)}
        calls, errors = {}, {}
        for name, change in changes.items():
            run = heyoka(scene, tolerance, **change)
            errors[name] = scene.error(run(scene.starts))
            calls[name] = partial(run, scene.starts)
        seconds = interleaved(calls, rounds)
        for name in changes:
            row = {"scene": scene.name, "changed": name, "error": errors[name]}
            rows.append(row | spread("time_ratio", seconds[name] / seconds["fastest"]))
    return pd.DataFrame(rows)
