"""A design at values other than the nominal ones: samples and corners of all tolerances."""

import itertools
from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from impact_damper.design.choose import spread
from impact_damper.design.outcomes import Case, interval, run, summarise
from impact_damper.design.task import NOMINAL, VARIED

# Samples of the tolerances, a power of 2 for Sobol's sequence; most frequencies and the starts at
# which each is run.
SAMPLES, SAMPLE_FREQUENCIES, SAMPLE_STARTS = 16, 7, 24
# Starts that the design has not seen: in all, at the nominal values and at each corner.
UNSEEN, CORNERS = 1000, 20


class Cloud(NamedTuple):
    """Motions of a design at several sets of deviations.

    Attributes
    ----------
    factors : numpy.ndarray, shape (m, len(VARIED))
        Values divided by the nominal ones, in the order of VARIED.
    worst : numpy.ndarray, shape (m,)
        Largest displacement of all motions over the band, mm.
    share : numpy.ndarray, shape (m, 3)
        Share of all starts over the band that end quiet, with its 95 % interval.
    least : numpy.ndarray, shape (m,)
        Least share at one of the frequencies.
    """

    factors: np.ndarray
    worst: np.ndarray
    share: np.ndarray
    least: np.ndarray


def sampled_factors(task) -> np.ndarray:
    """Return the nominal values, then deviations spread over the tolerances by Sobol's sequence."""
    names = [name for name in VARIED if task.tolerances.get(name)]
    factors = np.ones((SAMPLES, len(VARIED)))
    if not names:
        return factors[:1]
    points = qmc.Sobol(len(names), rng=task.seed).random(SAMPLES)
    for column, name in enumerate(names):
        factors[1:, VARIED.index(name)] += task.tolerances[name] * (2 * points[1:, column] - 1)
    return factors


def corner_factors(task) -> np.ndarray:
    """Return the nominal values, then corners of the tolerances, at most CORNERS of them."""
    widths = [task.tolerances.get(name, 0.0) for name in VARIED]
    signs = [(-1, 1) if width else (0,) for width in widths]
    corners = np.array(list(itertools.product(*signs)), float)
    if len(corners) > CORNERS:
        generator = np.random.default_rng(task.seed)
        corners = corners[np.sort(generator.permutation(len(corners))[:CORNERS])]
    corners = corners[np.any(corners != 0, axis=1)]
    return np.vstack([NOMINAL, 1 + corners * widths])


def run_cloud(task, gap, factors, frequencies, starts, limit, seed, **running) -> Cloud:
    """Return the motions at each set of deviations, over frequencies.

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
        Largest displacement of a quiet motion, mm.
    seed : int
    running
        `settling`, `workers` and `progress` of `outcomes.run`.
    """
    cases = [Case(1e-3 * gap, f, tuple(row)) for row in factors for f in frequencies]
    found = run(task, cases, starts, seed, **running)
    numbers = summarise(task, found, limit)
    shape = len(factors), len(frequencies)
    shares = numbers["start_quiet_share"].reshape(shape)
    counts = np.rint(shares.sum(axis=1) * starts).astype(int)
    total = len(frequencies) * starts
    return Cloud(
        factors,
        numbers["worst_displacement"].reshape(shape).max(axis=1),
        np.column_stack([counts / total, interval(counts, total)]),
        shares.min(axis=1),
    )


def sample_tolerances(task, gap, limit, **running) -> Cloud:
    """Return the motions at samples of all tolerances."""
    few = spread(task.grid, SAMPLE_FREQUENCIES)
    factors = sampled_factors(task)
    running = {"settling": task.hurried} | running
    return run_cloud(task, gap, factors, few, SAMPLE_STARTS, limit, task.seed + 40, **running)


def check_unseen(task, gap, limit, **running) -> Cloud:
    """Return the motions of UNSEEN new starts at the nominal values and at each corner."""
    starts = -(-UNSEEN // len(task.grid))
    factors = corner_factors(task)
    return run_cloud(task, gap, factors, task.grid, starts, limit, task.seed + 50, **running)
