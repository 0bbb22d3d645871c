"""The kernel against heyoka.py and SciPy at equal error, in one interleaved run."""

import pandas as pd

from benchmarks.accuracy import LIMIT, loosest
from benchmarks.heyoka_runs import BATCH, SETTINGS
from benchmarks.methods import METHODS, heyoka, starts_of
from benchmarks.timing import interleaved, spread

# Against whom each way of using the kernel is set.
RIVALS = {
    "kernel": ("heyoka", "dop853_events"),
    "kernel_ensemble": ("heyoka", "heyoka_batch", "dop853_events"),
}
TIMED = ("kernel", "kernel_ensemble", "heyoka", "heyoka_batch", "dop853_events")
MICRO = 1e6


def runs_of(scene, found):
    """Calls to be timed, and by what their seconds are divided: forcing periods."""
    calls, periods = {}, {}
    for name, each in found.items():
        starts = starts_of(scene, name)
        calls[name] = lambda run=each.run, starts=starts: run(starts)
        periods[name] = len(starts) * scene.periods
    return calls, periods


def compared(scenes, rounds, limit=LIMIT, timed=TIMED):
    """Times and ratios at equal error.

    Parameters
    ----------
    scenes : list of scenes.Scene
    rounds : int
    limit : float
        Largest error of any component of any state at the end.
    timed : sequence of str
        Names of methods.

    Returns
    -------
    times : pandas.DataFrame
        For each scene and method the loosest tolerance within the limit, its error, and the
        microseconds a forcing period and trajectory: median, quartiles and least.
    ratios : pandas.DataFrame
        For each use of the kernel and each rival, median and quartiles over rounds of the ratio of
        their times in that round.
    """
    times, ratios = [], []
    for scene in scenes:
        found = {}
        for name in timed:
            found[name] = loosest(scene, name, limit)
            each = found[name]
            print(f"  {scene.name}, {METHODS[name].title}: tolerance {each.tolerance:.1e}, "
                  f"error {each.error:.1e}{'' if each.met else ', limit not met'}", flush=True)  # fmt: skip
        calls, periods = runs_of(scene, found)
        seconds = interleaved(calls, rounds)
        per_period = {name: seconds[name] / periods[name] * MICRO for name in timed}
        for name in timed:
            median, lower, upper = spread(per_period[name])
            times.append({
                "scene": scene.name, "method": METHODS[name].title,
                "tolerance": found[name].tolerance, "error": found[name].error,
                "within_limit": "yes" if found[name].met else "no",
                "median_us": median, "lower_quartile_us": lower, "upper_quartile_us": upper,
                "least_us": per_period[name].min(),
            })  # fmt: skip
        for name, rivals in RIVALS.items():
            for rival in rivals:
                if name not in found or rival not in found:
                    continue
                median, lower, upper = spread(per_period[rival] / per_period[name])
                ratios.append({
                    "scene": scene.name, "ours": METHODS[name].title,
                    "rival": METHODS[rival].title, "times_faster": median,
                    "lower_quartile": lower, "upper_quartile": upper,
                    "equal_error": "yes" if found[name].met and found[rival].met else "no",
                })  # fmt: skip
                print(f"  {scene.name}: {median:.4g} times faster ({lower:.4g} to {upper:.4g}), "
                      f"{METHODS[name].title} than {METHODS[rival].title}", flush=True)  # fmt: skip
    return pd.DataFrame(times), pd.DataFrame(ratios)


def heyoka_settings(scenes, times, rounds):
    """How much slower heyoka.py is when one of its fastest settings is changed, by scene.

    `times` is the table of `compared`, whose tolerances are taken.
    """
    rows = []
    for scene in scenes:
        chosen = times[(times["scene"] == scene.name) & (times["method"] == METHODS["heyoka"].title)]
        tolerance = float(chosen["tolerance"].iloc[0])
        changes = {"fastest": {}} | SETTINGS
        changes |= {f"batch of {n}": {"batch": n} for n in (4, 8, 16) if n <= BATCH}
        calls, errors = {}, {}
        for name, change in changes.items():
            run = heyoka(scene, tolerance, **change)
            errors[name] = scene.error(run(scene.starts))
            calls[name] = lambda run=run, starts=scene.starts: run(starts)
        seconds = interleaved(calls, rounds)
        for name in changes:
            median, lower, upper = spread(seconds[name] / seconds["fastest"])
            rows.append({
                "scene": scene.name, "changed": name, "time_ratio": median,
                "lower_quartile": lower, "upper_quartile": upper, "error": errors[name],
            })  # fmt: skip
    return pd.DataFrame(rows)
