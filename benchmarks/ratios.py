"""Speed of the kernel against heyoka.py and SciPy at equal error, in one interleaved run.

The kernel is this package's compiled integrator. A scene is a test case: a motion with several
initial states.
"""

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
    calls = {
        name: lambda run=each.run, starts=starts[name]: run(starts) for name, each in found.items()
    }
    seconds = interleaved(calls, rounds)
    return {name: 1e6 * seconds[name] / (len(starts[name]) * scene.periods) for name in found}


def time_row(scene, name, found, measured):
    """Return a row of the table of times."""
    median, lower, upper = spread(measured)
    return {
        "scene": scene.name,
        "method": TIMED[name].title,
        "tolerance": found.tolerance,
        "error": found.error,
        "within_limit": "yes" if found.met else "no",
        "median_us": median,
        "lower_quartile_us": lower,
        "upper_quartile_us": upper,
        "least_us": measured.min(),
    }


def ratio_row(scene, name, rival, found, measured):
    """Return a row of the table of ratios."""
    median, lower, upper = spread(measured[rival] / measured[name])
    ours, other = TIMED[name].title, TIMED[rival].title
    print(f"  {scene.name}, {ours}: {median:.4g} times faster than {other}", flush=True)
    return {
        "scene": scene.name,
        "ours": ours,
        "rival": other,
        "times_faster": median,
        "lower_quartile": lower,
        "upper_quartile": upper,
        "equal_error": "yes" if found[name].met and found[rival].met else "no",
    }


def compared(scenes, rounds, limit=LIMIT, timed=COMPARED):
    """Return times and ratios at equal error.

    Parameters
    ----------
    scenes : list of scenes.BenchmarkScene
    rounds : int
    limit : float
        Largest error of any component of any state at the end.
    timed : sequence of str
        Names of methods.

    Returns
    -------
    times : pandas.DataFrame
        For each scene and method the loosest tolerance that keeps the limit, its error, and the
        microseconds for a forcing cycle of a trajectory: median, quartiles and least.
    ratios : pandas.DataFrame
        For each use of the kernel and each rival the ratio of their times in a round, median and
        quartiles over rounds; and whether both keep the limit.
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
            calls[name] = lambda run=run, starts=scene.starts: run(starts)
        seconds = interleaved(calls, rounds)
        for name in changes:
            median, lower, upper = spread(seconds[name] / seconds["fastest"])
            row = {"scene": scene.name, "changed": name, "time_ratio": median}
            row |= {"lower_quartile": lower, "upper_quartile": upper, "error": errors[name]}
            rows.append(row)
    return pd.DataFrame(rows)
