"""Section of a page: the effect of the damper.

A motion is quiet if the displacement of the machine is below a limit. A start is an initial state.
"""

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.machine_figures import response, transients
from impact_damper.plot.pages.blocks import Numbers, Picture, Section, shown

# The decay time of an unforced vibration is the time until it has fallen to this fraction.
DECAY = 0.1


def section(data) -> Section:
    """Return the section for the dataset of `stages.machines.design_damper`."""
    frequency = data["frequency"].values
    bare, reached = data["balance_displacement"].values, data["reached_displacement"].values
    peak, worst = int(np.argmax(bare)), int(np.argmax(reached))
    rows = [
        (
            "largest displacement without the damper",
            f"{shown(bare[peak], 'mm')} at {shown(frequency[peak], 'Hz', 4)}",
            "balance_displacement",
        ),
        (
            "largest displacement with the damper, of any motion to which starts lead",
            f"{shown(reached[worst], 'mm')} at {shown(frequency[worst], 'Hz', 4)}",
            "reached_displacement",
        ),
        (
            "95 % of the peaks of this largest motion are below",
            shown(data["motion_peak_high"].values[worst], "mm"),
            "motion_peak_high",
        ),
        (
            "r.m.s. displacement of this largest motion",
            shown(data["motion_rms"].values[worst], "mm"),
            "motion_rms",
        ),
        *_untouched(data, frequency),
        (
            "reduction: largest displacement without / with the damper",
            f"{shown(bare[peak] / reached[worst])} times",
            "balance_displacement, reached_displacement",
        ),
        (
            "a motion counts as quiet up to",
            shown(data["displacement_limit"], "mm"),
            "displacement_limit",
        ),
        *_swept(data),
        *_rung(data),
    ]
    pictures = [
        Picture("response", response.CAPTION),
        Picture("transients", transients.CAPTION),
    ]
    return Section("What it will do", [Numbers(rows), *pictures])


def _untouched(data, frequency):
    """Yield a row on the largest motion without contact, if this motion exceeds the quiet limit."""
    sizes = data["untouched_displacement"].values
    if np.fmax.reduce(sizes) > float(data["displacement_limit"]):
        k = int(np.nanargmax(sizes))
        yield (
            "not counted: largest displacement of a motion in which the loose mass touches no wall",
            f"{shown(sizes[k], 'mm')} at {shown(frequency[k], 'Hz', 4)}",
            "untouched_displacement",
        )


def _swept(data):
    """Yield the largest displacements in sweeps of the frequency, within and outside the band.

    The sweeps go through the resonances, which may lie outside the band.
    """
    low, high = parameters_of(data)["band"]
    for direction in data["direction"].values:
        swept = data.sel(direction=direction)
        turning = swept["sweep_frequency"]
        inside = (turning >= low) & (turning <= high)
        for where, words in ((inside, "through the band"), (~inside, "outside the band")):
            if not where.any():
                continue
            sizes = swept["sweep_envelope"].where(where).max("sweep_window")
            bare, damped = (shown(sizes.sel(equipment=name), "mm") for name in ("bare", "damped"))
            yield (
                f"largest displacement while the frequency is swept {direction} {words}, "
                "without / with the damper",
                f"{bare} / {damped}",
                "sweep_envelope, sweep_frequency",
            )


def _rung(data):
    """Yield the times in which an unforced vibration decays."""
    times = []
    for equipment in ("bare", "damped"):
        rung = data.sel(equipment=equipment)
        size, time = rung["ring_envelope"].values, rung["ring_time"].values
        known = np.isfinite(size)
        below = size[known] < DECAY * size[known][0]
        times.append(shown(time[known][np.argmax(below)] if below.any() else np.nan, "s"))
    first = shown(data["ring_envelope"].sel(equipment="bare").values[0], "mm")
    yield (
        f"time in which an unforced vibration of {first} decays to a tenth, without / with the "
        "damper",
        " / ".join(times),
        "ring_envelope, ring_time",
    )
