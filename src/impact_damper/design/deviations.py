"""Tests of a design with deviating values: samples and corners of all tolerances.

A tolerance is the largest relative deviation of a value from its nominal one. In a sample the
values deviate at random within their tolerances. At a corner each value deviates by its whole
tolerance, up or down. At each set of values motions are run from random starts (initial states). A
start is quiet if its motion stays below the quiet limit. A design claims, at 95 % confidence, that
at least a given share of all starts is quiet at each frequency of the band. The promise is this
claim to the user.
"""

import itertools
from typing import NamedTuple

import numpy as np
from scipy.special import bdtr
from scipy.stats import qmc

from impact_damper.data.shares import wilson
from impact_damper.design.choose import Choice
from impact_damper.design.outcomes import Case, run, summarise
from impact_damper.design.task import spread
from impact_damper.design.tolerances import NOMINAL, VARIED

# SAMPLES: number of samples, a power of 2 for Sobol's sequence.
# SAMPLE_FREQUENCIES, SAMPLE_STARTS: frequencies, and starts at each, with which a sample is run.
SAMPLES, SAMPLE_FREQUENCIES, SAMPLE_STARTS = 16, 7, 24
# TRIED: number of gaps that are tried with deviations of all values.
# TRIED_FREQUENCIES, TRIED_STARTS: frequencies, and starts at each, with which a gap is tried.
TRIED, TRIED_FREQUENCIES, TRIED_STARTS = 5, 5, 12
# UNSEEN: new starts, not used by the design, at the nominal values and at each corner.
# CORNERS: largest number of corners; of more, some are drawn.
UNSEEN, CORNERS = 1000, 20
# Probability with which a promise that is true is called broken by chance.
FALSE_ALARM = 0.05


class Cloud(NamedTuple):
    """Motions of a design at several sets of deviations.

    Attributes
    ----------
    factors : numpy.ndarray, shape (m, len(VARIED))
        Values divided by the nominal ones, in the order of VARIED.
    worst : numpy.ndarray, shape (m,)
        Largest displacement of all motions over the band, mm.
    share : numpy.ndarray, shape (m, 3)
        Share of all starts over the band that lead to quiet motions, with its 95 % interval.
    least : numpy.ndarray, shape (m,)
        Share of quiet starts at the worst frequency.
    starts : int
        Starts at each frequency.
    frequencies : int
        Number of frequencies.
    """

    factors: np.ndarray
    worst: np.ndarray
    share: np.ndarray
    least: np.ndarray
    starts: int
    frequencies: int

    def keeps(self, share) -> np.ndarray:
        """Return whether the starts of each set agree with a claimed share, shape (m,) of bool.

        They disagree in two cases. Either the share of quiet starts over the band is smaller than
        claimed. Or the share at one frequency is much smaller: if the claim were true, a share so
        small at any frequency of any set would have a probability below FALSE_ALARM.
        """
        chance = bdtr(np.rint(self.least * self.starts), self.starts, share)
        agree = chance >= FALSE_ALARM / (self.frequencies * len(self.least))
        return (self.share[:, 0] >= share) & agree


def sampled_factors(task) -> np.ndarray:
    """Return the nominal values, then SAMPLES samples of the tolerances.

    The rows are factors of the nominal values, in the order of VARIED. The samples are the first
    points of a scrambled Sobol sequence, which fills the tolerances evenly. Without tolerances only
    the nominal values are returned.
    """
    names = [name for name in VARIED if task.tolerances.get(name)]
    factors = np.ones((SAMPLES + 1 if names else 1, len(VARIED)))
    if names:
        points = qmc.Sobol(len(names), rng=task.seed).random(SAMPLES)
        for name, column in zip(names, points.T, strict=True):
            factors[1:, VARIED.index(name)] += task.tolerances[name] * (2 * column - 1)
    return _possible(task, factors)


def _possible(task, factors):
    """Return the factors, reduced for the restitution where it would exceed 1."""
    place = VARIED.index("restitution")
    factors[:, place] = np.minimum(factors[:, place], 1 / task.restitution)
    return factors


def corner_factors(task) -> np.ndarray:
    """Return the nominal values, then at most CORNERS corners of the tolerances.

    The rows are factors of the nominal values, in the order of VARIED.
    """
    widths = [task.tolerances.get(name, 0.0) for name in VARIED]
    signs = [(-1, 1) if width else (0,) for width in widths]
    corners = np.array(list(itertools.product(*signs)), float)
    if len(corners) > CORNERS:
        generator = np.random.default_rng(task.seed)
        corners = corners[np.sort(generator.permutation(len(corners))[:CORNERS])]
    corners = corners[np.any(corners != 0, axis=1)]
    return _possible(task, np.vstack([NOMINAL, 1 + corners * widths]))


def deviating_factors(task) -> np.ndarray:
    """Return the rows of `sampled_factors`, then the corners of `corner_factors`."""
    return np.vstack([sampled_factors(task), corner_factors(task)[1:]])


def run_cloud(task, gap, factors, frequencies, starts, limit, stream, **running) -> Cloud:
    """Run motions at each set of deviations and each frequency, and return their `Cloud`.

    Parameters
    ----------
    task : Task
    gap : float
        Nominal gap, mm.
    factors : array, shape (m, len(VARIED))
    frequencies : array, shape (n,)
        Hz.
    starts : int
        Random starts at each frequency.
    limit : float
        Quiet limit, mm.
    stream, running
        `stream`, `settling`, `workers` and `progress` of `outcomes.run`.
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


def sample_tolerances(task, gap, frequency, limit, **running) -> Cloud:
    """Return the `Cloud` of the motions at samples and corners of all tolerances.

    The motions are run at some frequencies of the band, one of which is `frequency` (Hz). `gap` and
    `limit` are in mm.
    """
    few = task.few(SAMPLE_FREQUENCIES, frequency)
    running = {"settling": task.hurried} | running
    factors = deviating_factors(task)
    return run_cloud(task, gap, factors, few, SAMPLE_STARTS, limit, "samples", **running)


def choose_with_tolerances(task, comparison, choice, **running) -> Choice:
    """Return the choice of a robust gap, moved to where all tolerances together do least harm.

    At a robust gap, deviations of the gap alone leave the motions quiet. Several robust gaps are
    therefore run at samples and corners of all tolerances. If at some gaps the share of quiet
    starts is large enough at every sample and corner, the gap among these with the smallest worst
    displacement is returned. Otherwise the gap whose smallest share is largest is returned.

    Parameters
    ----------
    task : Task
    comparison : choose.Comparison
    choice : choose.Choice
    running
        `workers` and `progress` of `outcomes.run`.
    """
    others = [value for name, value in task.tolerances.items() if name != "gap"]
    if choice.kind != "robust" or not any(others):
        return choice
    robust = comparison.robust_gaps(task.tolerances.get("gap", 0.0))
    gaps = np.union1d(spread(robust, TRIED), [choice.gap])
    few, factors = task.few(TRIED_FREQUENCIES), deviating_factors(task)
    running = {"settling": task.hurried} | running
    scores = []
    for gap in gaps:
        cloud = run_cloud(
            task, gap, factors, few, TRIED_STARTS, comparison.limit, "deviations", **running
        )
        lacking = max(0.0, task.share - cloud.share[:, 0].min())
        scores.append((lacking, cloud.worst.max()))
    return choice._replace(gap=float(gaps[min(range(len(gaps)), key=scores.__getitem__)]))


def check_unseen(task, gap, limit, **running) -> Cloud:
    """Return the `Cloud` of UNSEEN new starts at the nominal values and at each corner."""
    starts = -(-UNSEEN // len(task.grid))
    factors = corner_factors(task)
    return run_cloud(task, gap, factors, task.grid, starts, limit, "unseen", **running)


def promise(task, kind, samples, unseen) -> str:
    """Return the value of the flag `promise`.

    The flag says what a design promises, and whether new starts confirm the promise. A design with
    a quiet gap promises that at its nominal values, at each frequency, at least `task.share` of the
    starts lead to quiet motions. A robust design promises this within all tolerances, provided that
    the samples and corners of the tolerances agree with this claim.

    Parameters
    ----------
    task : Task
    kind : str
        The attribute of `choose.Choice`.
    samples, unseen : Cloud
        Motions at samples of the tolerances, and from new starts at nominal values and corners.
    """
    if kind == "least_worst":
        return "none_made"
    kept = unseen.keeps(task.share)
    if kind == "robust" and samples.keeps(task.share).all():
        return "robust_kept" if kept.all() else "broken"
    return "nominal_kept" if kept[0] else "broken"
