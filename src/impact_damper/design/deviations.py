"""Tests of a design with deviating values: samples and corners of all tolerances, and new starts.

In a sample the values deviate at random within their tolerances. At a corner each value deviates by
its whole tolerance, up or down.
"""

import itertools
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.special import bdtr
from scipy.stats import qmc

from impact_damper.data.datasets import decode, flag
from impact_damper.data.shares import BOUNDS, wilson
from impact_damper.design.choose import Choice, robust_gaps
from impact_damper.design.outcomes import Case, run, summarise
from impact_damper.design.task import NOMINAL, VARIED, labelled, spread

# SAMPLES: number of samples, a power of 2 for Sobol's sequence.
# SAMPLE_FREQUENCIES, SAMPLE_STARTS: frequencies, and starts at each, with which a sample is run.
SAMPLES, SAMPLE_FREQUENCIES, SAMPLE_STARTS = 16, 7, 24
# Number of gaps that are tried with deviations of all values; frequencies, and starts at each.
TRIED, TRIED_FREQUENCIES, TRIED_STARTS = 5, 5, 12
# UNSEEN: new starts, not used by the design, at the nominal values and at each corner.
# CORNERS: largest number of corners; of more, some are drawn.
UNSEEN, CORNERS = 1000, 20
# Probability with which a promise that is true is called broken by chance.
FALSE_ALARM = 0.05


class Cloud(NamedTuple):
    """Motions at m sets of deviations.

    `factors` multiply the nominal values in the order of VARIED, shape (m, len(VARIED)); `worst` is
    the largest displacement over the band (mm), `share` the share of quiet starts over the band
    with its 95 % interval, shape (m, 3), and `least` the share at the worst frequency.
    """

    factors: np.ndarray
    worst: np.ndarray
    share: np.ndarray
    least: np.ndarray
    starts: int
    frequencies: int

    def keeps(self, share) -> np.ndarray:
        """Return whether the starts of each set agree with a claimed share, shape (m,) of bool.

        The share over the band must not be smaller. At one frequency it may be smaller, unless the
        probability of so small a share at any frequency of any set is below FALSE_ALARM.
        """
        chance = bdtr(np.rint(self.least * self.starts), self.starts, share)
        agree = chance >= FALSE_ALARM / (self.frequencies * len(self.least))
        return (self.share[:, 0] >= share) & agree


def check_design(task, choice, progress=None) -> xr.Dataset:
    """Return the tests of a design with deviating values and with new starts.

    `choice` is the dataset of `cliff.choose_gap`.
    """
    gap, limit = float(choice["design_gap"]), float(choice["displacement_limit"])
    frequencies = task.few(SAMPLE_FREQUENCIES, float(choice["branch_frequency"]))
    running = {"settling": task.hurried, "progress": progress}
    factors = np.vstack([sampled_factors(task), corner_factors(task)[1:]])
    samples = run_cloud(task, gap, factors, frequencies, SAMPLE_STARTS, limit, "samples", **running)
    unseen = check_unseen(task, gap, limit, progress=progress)
    kept = promise(task, decode(choice["design_choice"]).item(), samples, unseen)
    values = {"promise": flag("promise", kept)}
    for prefix, cloud in (("sample", samples), ("corner", unseen)):
        values |= {
            f"{prefix}_factor": cloud.factors,
            f"{prefix}_displacement": cloud.worst,
            f"{prefix}_share": cloud.share,
        }
    return labelled(values, varied=list(VARIED), bound=BOUNDS)


def sampled_factors(task) -> np.ndarray:
    """Return the nominal factors, then those of SAMPLES points of a scrambled Sobol sequence."""
    names = [name for name in VARIED if task.tolerances.get(name)]
    factors = np.ones((SAMPLES + 1 if names else 1, len(VARIED)))
    if names:
        points = qmc.Sobol(len(names), rng=task.effort.seed).random(SAMPLES)
        for name, column in zip(names, points.T, strict=True):
            factors[1:, VARIED.index(name)] += task.tolerances[name] * (2 * column - 1)
    return _possible(task, factors)


def corner_factors(task) -> np.ndarray:
    """Return the nominal factors, then those of at most CORNERS corners of the tolerances."""
    widths = [task.tolerances.get(name, 0.0) for name in VARIED]
    signs = [(-1, 1) if width else (0,) for width in widths]
    corners = np.array(list(itertools.product(*signs)), float)
    if len(corners) > CORNERS:
        generator = np.random.default_rng(task.effort.seed)
        corners = corners[np.sort(generator.permutation(len(corners))[:CORNERS])]
    corners = corners[np.any(corners != 0, axis=1)]
    return _possible(task, np.vstack([NOMINAL, 1 + corners * widths]))


def _possible(task, factors):
    """Return the factors, reduced for the restitution where it would exceed 1."""
    place = VARIED.index("restitution")
    factors[:, place] = np.minimum(factors[:, place], 1 / task.restitution)
    return factors


def run_cloud(task, gap, factors, frequencies, starts, limit, stream, **running) -> Cloud:
    """Run motions at each set of deviations of a gap (mm) and each frequency (Hz).

    `starts` is their number at each frequency, `limit` the quiet limit (mm), and `stream` and
    `running` are arguments of `outcomes.run`.
    """
    cases = [Case(1e-3 * gap, f, tuple(row)) for row in factors for f in frequencies]
    numbers = summarise(task, run(task, cases, starts, stream, **running), limit)
    shape = len(factors), len(frequencies)
    shares = numbers["start_quiet_share"].reshape(shape)
    counts = np.rint(shares.sum(axis=1) * starts)
    return Cloud(
        factors,
        numbers["worst_displacement"].reshape(shape).max(axis=1),
        np.array([wilson(count, len(frequencies) * starts) for count in counts]),
        shares.min(axis=1),
        starts,
        len(frequencies),
    )


def choose_with_tolerances(task, compared, choice, progress=None) -> Choice:
    """Return the choice of a robust gap, moved to where all tolerances together do least harm.

    At a robust gap, deviations of the gap alone leave the motions quiet. Several robust gaps are
    therefore run at samples and corners of all tolerances. The gap with the smallest worst
    displacement is returned among those whose share is large enough at every sample and corner, or
    else the gap whose smallest share is largest.
    """
    others = [value for name, value in task.tolerances.items() if name != "gap"]
    if choice.kind != "robust" or not any(others):
        return choice
    robust = robust_gaps(compared, task.share, task.gap_tolerance)
    gaps = np.union1d(spread(robust, TRIED), [choice.gap])
    few = task.few(TRIED_FREQUENCIES)
    factors = np.vstack([sampled_factors(task), corner_factors(task)[1:]])
    limit = float(compared["displacement_limit"])
    running = {"settling": task.hurried, "progress": progress}
    scores = []
    for gap in gaps:
        cloud = run_cloud(task, gap, factors, few, TRIED_STARTS, limit, "deviations", **running)
        lacking = max(0.0, task.share - cloud.share[:, 0].min())
        scores.append((lacking, cloud.worst.max()))
    return choice._replace(gap=float(gaps[min(range(len(gaps)), key=scores.__getitem__)]))


def check_unseen(task, gap, limit, progress=None) -> Cloud:
    """Return the `Cloud` of UNSEEN new starts at the nominal values and at each corner."""
    starts = -(-UNSEEN // len(task.grid))
    given = (corner_factors(task), task.grid, starts, limit, "unseen")
    return run_cloud(task, gap, *given, progress=progress)


def promise(task, kind, samples, unseen) -> str:
    """Return the name of the flag `promise`.

    A design with a quiet gap promises that at its nominal values, at each frequency, at least
    `task.share` of the starts lead to quiet motions. A robust design promises this within all
    tolerances, provided that `samples` agree with this claim. The new starts `unseen` confirm it.
    """
    if kind == "least_worst":
        return "none_made"
    kept = unseen.keeps(task.share)
    if kind == "robust" and samples.keeps(task.share).all():
        return "robust_kept" if kept.all() else "broken"
    return "nominal_kept" if kept[0] else "broken"
