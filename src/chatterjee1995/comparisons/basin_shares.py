"""Published basin shares of an oscillator with five coexisting motions.

The basin share of a motion is the share of random starts (initial states) that lead to it.

The oscillator x'' + 0.08 x' + x^3 = 0.2 cos t is from Thompson and Stewart, Nonlinear Dynamics and
Chaos, 1986. It is a test case of two programs: bSTAB (Stender and Hoffmann, "bSTAB: an open-source
software for computing the basin stability of multi-stable dynamical systems", Nonlinear Dyn. 107,
1451-1468, 2022, doi 10.1007/s11071-021-06786-5) and its successor pybasin. Starts (x, x') are drawn
uniformly from a box. The shares in this module were computed by bSTAB from 10 000 starts. They are
published in the repository of pybasin (github.com/adrianwix/pybasin, commit 925877c,
artifacts/results/duffing_case1_comparison.json). The shares computed by pybasin, in the same order,
are 0.2023, 0.4950, 0.0288, 0.0257 and 0.2482.
"""

from typing import NamedTuple

DAMPING, FORCE, FREQUENCY = 0.08, 0.2, 1.0
# BOX: least and greatest x, least and greatest x' of the starts. STARTS: number of starts.
BOX = (-1.0, 1.0), (-0.5, 1.0)
STARTS = 10_000


class PublishedMotion(NamedTuple):
    """One of the five motions.

    Attributes
    ----------
    name : str
        Name in bSTAB.
    meaning : str
        The motion in words.
    start : tuple of float
        A start (x, x') that leads to the motion.
    share : float
        Share of the starts that lead to the motion, computed by bSTAB.
    """

    name: str
    meaning: str
    start: tuple[float, float]
    share: float


MOTIONS = (
    PublishedMotion("y1", "small motion of period 1", (-0.21, 0.02), 0.2027),
    PublishedMotion("y2", "large motion of period 1", (1.05, 0.77), 0.4950),
    PublishedMotion("y3", "first motion of period 2", (-0.67, 0.02), 0.0288),
    PublishedMotion("y4", "second motion of period 2", (-0.46, 0.30), 0.0257),
    PublishedMotion("y5", "motion of period 3", (-0.43, 0.12), 0.2478),
)
