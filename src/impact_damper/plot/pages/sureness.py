"""Section of a page: how sure the result of a design is.

A start is a random initial state. It is quiet if it leads to a quiet motion, one below the
displacement limit. The cliff is the gap at which the share of quiet starts falls. A corner combines
extreme values of all tolerances.
"""

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.data.sweeps import stable_range
from impact_damper.plot.machine_figures import cliff, operating, tolerances
from impact_damper.plot.pages.blocks import (
    Numbers,
    Picture,
    Section,
    Table,
    Words,
    percent,
    share_with_interval,
    shown,
)

MEANING = (
    "A damper that works from one start may fail from another, because other motions can exist "
    "in addition to the quiet one. Therefore motions are run from many random starts, up to three "
    "times as large and as fast as the motions without the damper. A motion is quiet if the "
    "machine moves at most {limit}. For a motion that never repeats the limit is {chaotic} while "
    "it is watched, because later peaks may be larger. The share of starts that lead to quiet "
    "motions is known within a 95 % interval, given in brackets. A gap counts as quiet if, at "
    "every frequency of the band, the lower end of this interval is at least {share}."
)
TIME = (
    "A share depends on the length of the runs. A short run has at most {hurried} cycles of the "
    "forcing ({seconds}), a long run at most {limit}. The coarse comparison of gaps, the samples "
    "of the tolerances and the maps have short runs. In the comparison of candidates, motions that "
    "were not quiet after a short run had a long run, unless their gap had failed already. Motions "
    "with the gap to build and the check with new starts have long runs. A motion that is "
    "certainly chaotic was stopped after {early} cycles in a short run, and after {patience} "
    "cycles in a long run."
)
DEPENDENCE = (
    "Change of the quiet orbit at {frequency} if one value grows by 1 %, by exact derivatives. The "
    "orbit is stable as long as its largest Floquet multiplier has a modulus below 1."
)
TRAP = (
    "The gap of the smallest stable quiet orbit is {best}, at {frequency}. It is not the gap to "
    "build: the gap is chosen by the share of starts that lead to quiet motions, not by the size "
    "or the stability of the orbit."
)


def section(data) -> Section:
    """Return the section for the dataset of `stages.machines.design_damper`."""
    asked = parameters_of(data)
    blocks = [
        Words(_meaning(data, asked)),
        Numbers([*_shares(data, asked), *_edges(data)]),
        Words(_time(data, asked)),
        *_dependence(data),
    ]
    best = float(data["best_orbit_gap"])
    if np.isfinite(best):
        where = shown(data["best_orbit_frequency"], "Hz", 4)
        blocks.append(Words(TRAP.format(best=shown(best, "mm"), frequency=where)))
    pictures = [
        Picture("cliff", cliff.CAPTION),
        Picture("tolerances", tolerances.CAPTION),
        Picture("forces", operating.FORCES),
        Picture("dampers", operating.DAMPERS),
    ]
    return Section("How sure that is", [*blocks, *pictures])


def _meaning(data, asked):
    """Return the paragraph that defines a share of quiet starts."""
    limit = float(data["displacement_limit"])
    return MEANING.format(
        share=percent(asked["share"]),
        limit=shown(limit, "mm"),
        chaotic=shown(limit / asked["later_displacement"], "mm"),
    )


def _time(data, asked):
    """Return the paragraph on the lengths of the runs."""
    hurried, full = asked["compared_settling"], asked["settling"]
    seconds = hurried["limit"] / data["frequency"].values.mean()
    return TIME.format(
        hurried=hurried["limit"],
        seconds=f"about {shown(seconds, 's', 2)}",
        early=hurried["patience"],
        limit=full["limit"],
        patience=full["patience"],
    )


def _shares(data, asked):
    """Yield rows on shares of quiet starts: the starts used to choose the gap, and new starts."""
    row = int(np.argmin(np.abs(data["candidate_gap"].values - float(data["design_gap"]))))
    shares = data["start_quiet_share"].values[row]
    k = int(np.argmin(shares))
    chosen = [shares[k], *data["start_quiet_interval"].values[row, k]]
    gap = shown(data["candidate_gap"].values[row], "mm")
    yield (
        f"share of quiet starts at the worst frequency, {asked['starts']} starts at each, nearest "
        f"gap compared ({gap})",
        share_with_interval(chosen),
        "start_quiet_share, start_quiet_interval",
    )
    yield (
        "cycles in which these motions settle on a periodic quiet motion, median / 95 %, at the "
        "slowest frequency",
        _times(data, row),
        "quiet_time_median, quiet_time_late",
    )
    shares = data["reached_quiet_share"].values
    k = int(np.argmin(shares))
    yield (
        f"share of quiet starts at the worst frequency, gap to build, {asked['starts']} starts",
        share_with_interval([shares[k], *data["reached_quiet_interval"].values[k]]),
        "reached_quiet_share, reached_quiet_interval",
    )
    unseen, sizes = data["corner_share"].values, data["corner_displacement"].values
    yield (
        "1000 new starts over the band, nominal values",
        f"{share_with_interval(unseen[0])}, largest displacement {shown(sizes[0], 'mm')}",
        "corner_share, corner_displacement",
    )
    if len(unseen) > 1:
        k = 1 + int(np.argmin(unseen[1:, 0]))
        yield (
            f"the worst of {len(unseen) - 1} corners of the tolerances, 1000 new starts each",
            f"{share_with_interval(unseen[k])}, largest displacement of all corners "
            f"{shown(sizes[1:].max(), 'mm')}",
            "corner_share, corner_displacement",
        )
    samples = data["sample_share"].values
    if len(samples) > 1:
        k = int(np.argmin(samples[:, 0]))
        yield (
            f"the worst of {len(samples)} samples and corners of the tolerances",
            share_with_interval(samples[k]),
            "sample_share",
        )
    yield (
        "share of starts that lead to motions not found, at most",
        percent(data["missed_share"]),
        "missed_share",
    )


def _times(data, row):
    """Return the longest median and the longest 95th percentile of settling times, as text."""
    median, late = (
        np.fmax.reduce(data[f"quiet_time_{name}"].values[row]) for name in ("median", "late")
    )
    if np.isnan(median):
        return "not known: the quiet motions found never repeat"
    return f"{shown(median)} / {shown(late)}"


def _dependence(data):
    """Yield the table of derivatives of the quiet orbit, if there is one."""
    size, modulus = data["displacement_change"].values, data["modulus_change"].values
    if not np.isfinite(size).any():
        return
    yield Words(DEPENDENCE.format(frequency=shown(data["branch_frequency"], "Hz", 4)))
    rows = [
        [str(name).replace("_", " "), *(f"{value:.2f} %" for value in changes)]
        for name, *changes in zip(data["changed"].values, size, modulus, strict=True)
        if any(changes)
    ]
    columns = ["value that grows by 1 %", "displacement", "largest multiplier"]
    yield Table(columns, rows, "displacement_change, modulus_change")


def _edges(data):
    """Yield rows on the ends of the quiet gaps, and on the stability of the quiet orbit."""
    gap = float(data["design_gap"])
    for k, side in enumerate(("below", "above")):
        edge, beyond, frequency = (
            float(data[name][k]) for name in ("cliff_gap", "cliff_beyond", "cliff_frequency")
        )
        if np.isfinite(beyond):
            value = (
                f"{shown(edge, 'mm', 4)}, {percent(abs(edge / gap - 1))} {side} the gap to build "
                f"(at {shown(frequency, 'Hz', 4)})"
            )
        elif np.isfinite(edge):
            way = "up" if k else "down"
            value = f"none found: quiet at least {way} to {shown(edge, 'mm', 4)}, the last compared"
        else:
            value = "no gap compared is quiet over the band"
        yield f"cliff {side}: last quiet gap", value, "cliff_gap, cliff_beyond, cliff_frequency"
    stable = stable_range(data, "gap")
    if stable:
        k = int(np.argmin(np.abs(data["gap_of_orbit"].values - gap)))
        where = f"at {shown(data['branch_frequency'], 'Hz', 4)}"
        yield (
            f"largest multiplier of the quiet orbit at the gap to build, {where} (stable below 1)",
            shown(data["modulus_by_gap"].values[k]),
            "modulus_by_gap, gap_of_orbit, branch_frequency",
        )
        yield (
            f"gaps at which the quiet orbit is stable, {where}",
            f"{stable} mm",
            "stability_gap, stability_gap_event, branch_frequency",
        )
    stable = stable_range(data, "force")
    if stable:
        yield (
            "range of excitation / nominal at which the quiet orbit is stable",
            stable,
            "stability_force, stability_force_event",
        )
