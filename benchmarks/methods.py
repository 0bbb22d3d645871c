"""Methods that are timed, with one interface.

For a scene (a test case) and a tolerance a method prepares a function from starts (initial states)
to states at the end. The kernel is this package's compiled integrator. The integrators compared
with the kernel are called rivals and come from `chatterjee1995.methods.integrators`.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from benchmarks.heyoka_runs import BATCH, Motions
from chatterjee1995.methods.integrators import runs_of_accuracy
from chatterjee1995.methods.integrators.taylor import ROWS, SERIES, steps_of, take_steps
from chatterjee1995.methods.labels import method_in_words
from impact_damper.kernel import batch
from impact_damper.kernel.single import workspace
from impact_damper.kernel.tangents import advance

NO_TANGENTS = np.empty((0, 4))
# Largest number of evaluations of the rate in a run of a slow integrator.
MOST_EVALUATIONS = 200_000


class TimedMethod(NamedTuple):
    """One way to integrate.

    Attributes
    ----------
    title : str
    prepare : callable
        Takes a scene and a tolerance, and returns a function from starts, shape (m, 4), to states
        at the end, shape (m, 4), NaN where a run failed. Compilation happens here and is not timed.
    slow : bool
        Whether the method is run from the first start only.
    """

    title: str
    prepare: Callable
    slow: bool = False


def single(scene, tolerance):
    """Prepare the kernel, called from Python for each start; the starts must be in flight."""
    p, begin, end, work = scene.parameters, scene.begin, scene.end, workspace()

    def run(starts):
        states = starts.copy()
        for y in states:
            advance(p, y, NO_TANGENTS, 0, begin, end, tolerance, work)
        return states

    return run


def of_orders(orders):
    """Return `prepare` for the kernel with other Taylor orders, in flight and in contact."""

    def prepare(scene, tolerance):
        p, rows, made = scene.parameters, np.empty((ROWS, SERIES)), steps_of(orders)

        def run(starts):
            states = starts.copy()
            for y in states:
                take_steps(made, p, y, 0, scene.begin, scene.end, tolerance, *orders, rows)
            return states

        return run

    return prepare


def advance_rows(scene, states, tolerance):
    """Advance states in place to the end of the scene, as an ensemble (several states together)."""
    count = len(states)
    rows = np.tile(scene.parameters, (count, 1))
    sides, contacts = np.zeros((2, count), int)
    times = (np.full(count, time) for time in (scene.begin, scene.end))
    batch.advance(rows, states, sides, *times, tolerance, contacts)


def ensemble(scene, tolerance):
    """Prepare the kernel, called once for all starts."""

    def run(starts):
        states = starts.copy()
        advance_rows(scene, states, tolerance)
        return states

    return run


def heyoka(scene, tolerance, **settings):
    """Prepare heyoka.py: one integrator, used for one start after the other."""
    motions = Motions(scene.parameters, tolerance, **settings)
    return lambda starts: motions.run(scene, starts)


def heyoka_batch(scene, tolerance):
    """Prepare heyoka.py's batch mode, which integrates BATCH trajectories together."""
    return heyoka(scene, tolerance, batch=BATCH)


def rival(label):
    """Return the timed method for a label of `runs_of_accuracy`, called for each start."""
    integrator, locate = runs_of_accuracy()[label]

    def prepare(scene, tolerance):
        given = scene.begin, scene.periods, tolerance, locate, MOST_EVALUATIONS

        def end(start):
            status, _, _, states = integrator.steps(scene.parameters, start, *given)
            return states[-1] if status == "ended" else np.full(4, np.nan)

        return lambda starts: np.array([end(start) for start in starts])

    return TimedMethod(method_in_words(label), prepare, integrator.slow)


RIVALS = tuple(label for label in runs_of_accuracy() if label != "taylor")
TIMED = {
    "kernel": TimedMethod("this kernel, one at a time", single),
    "kernel_ensemble": TimedMethod("this kernel, ensemble", ensemble),
    "kernel_12_15": TimedMethod("this kernel, orders 12 and 15", of_orders((12, 15))),
    "kernel_24_30": TimedMethod("this kernel, orders 24 and 30", of_orders((24, 30))),
    "heyoka": TimedMethod("heyoka.py, one at a time", heyoka),
    "heyoka_batch": TimedMethod("heyoka.py, batch mode", heyoka_batch),
    **{label: rival(label) for label in RIVALS},
}


def starts_of(scene, name):
    """Return the starts from which a method is run."""
    return scene.starts[:1] if TIMED[name].slow else scene.starts


def applying(scene):
    """Return the names of the methods for a scene.

    Without a damper there are no contacts to locate, so the methods `..._located` are left out.
    """
    return [name for name in TIMED if scene.components == 4 or not name.endswith("_located")]
