"""Methods that are timed, behind one face: a scene and a tolerance give a function of starts."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from benchmarks import scipy_runs
from benchmarks.heyoka_runs import BATCH, Motions
from impact_damper.kernel import batch
from impact_damper.kernel.single import advance, workspace
from impact_damper.rivals.merson import run_merson
from impact_damper.rivals.taylor_runs import ROWS, SERIES, steps_of, take_steps

NO_TANGENTS = np.empty((0, 4))


class Method(NamedTuple):
    """One way to integrate.

    Attributes
    ----------
    title : str
    prepare : callable
        Of a scene and a tolerance; returns a function from starts (m, 4) to states (m, 4), NaN
        where a run failed. What it compiles is not timed.
    slow : bool
        Whether one start must do where others take all.
    """

    title: str
    prepare: Callable
    slow: bool = False


def single(scene, tolerance):
    """The kernel from states in flight, called from Python once a run."""
    p, begin, end, work = scene.parameters, scene.begin, scene.end, workspace()

    def run(starts):
        states = starts.copy()
        for y in states:
            advance(p, y, NO_TANGENTS, 0, begin, end, tolerance, work)
        return states

    return run


def of_orders(orders):
    """The kernel with series of other orders, in flight and in contact."""

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
    """The kernel over states in flight, several side by side; they are replaced."""
    count = len(states)
    rows = np.tile(scene.parameters, (count, 1))
    sides, contacts = np.zeros((2, count), int)
    times = (np.full(count, time) for time in (scene.begin, scene.end))
    batch.advance(rows, states, sides, *times, tolerance, contacts)


def ensemble(scene, tolerance):
    """The kernel, called once for all starts."""

    def run(starts):
        states = starts.copy()
        advance_rows(scene, states, tolerance)
        return states

    return run


def heyoka(scene, tolerance, **settings):
    """heyoka.py, its integrator made once and used for one start after the other."""
    motions = Motions(scene.parameters, tolerance, **settings)
    return lambda starts: motions.run(scene, starts)


def heyoka_batch(scene, tolerance):
    """heyoka.py's batch mode; its events call back for each trajectory."""
    return heyoka(scene, tolerance, batch=BATCH)


def scipy(method, locate):
    """One of SciPy's methods with a compiled rate, with contacts as events or through the kink."""

    def prepare(scene, tolerance):
        def run(starts):
            p, begin, end = scene.parameters, scene.begin, scene.end
            return np.array(
                [scipy_runs.run(method, p, y, begin, end, tolerance, locate) for y in starts]
            )

        return run

    return prepare


def merson(locate):
    """The paper's Runge-Kutta-Merson with step control."""

    def prepare(scene, tolerance):
        strobes, largest = np.empty((scene.periods, 4)), np.empty(scene.periods)

        def run(starts):
            states = np.empty_like(starts)
            for i, y in enumerate(starts):
                run_merson(scene.parameters, y, scene.begin, tolerance, locate, strobes, largest)
                states[i] = strobes[-1]
            return states

        return run

    return prepare


METHODS = {
    "kernel": Method("this kernel, one at a time", single),
    "kernel_ensemble": Method("this kernel, ensemble", ensemble),
    "kernel_12_15": Method("this kernel, orders 12 and 15", of_orders((12, 15))),
    "kernel_24_30": Method("this kernel, orders 24 and 30", of_orders((24, 30))),
    "heyoka": Method("heyoka.py, one at a time", heyoka),
    "heyoka_batch": Method("heyoka.py, batch mode", heyoka_batch),
    "merson_located": Method("Runge-Kutta-Merson, contacts located", merson(True)),
    "merson": Method("Runge-Kutta-Merson, through the kink", merson(False)),
    "dop853_events": Method("DOP853 with events", scipy("DOP853", True), slow=True),
    "dop853": Method("DOP853, through the kink", scipy("DOP853", False), slow=True),
    "lsoda_events": Method("LSODA with events", scipy("LSODA", True), slow=True),
    "lsoda": Method("LSODA, through the kink", scipy("LSODA", False), slow=True),
    "radau_events": Method("Radau with events", scipy("Radau", True), slow=True),
    "radau": Method("Radau, through the kink", scipy("Radau", False), slow=True),
}
# What is the same without contacts as another method.
NEEDS_CONTACTS = ("merson_located", "dop853_events", "lsoda_events", "radau_events")


def starts_of(scene, name):
    """The starts from which a method is run."""
    return scene.starts[:1] if METHODS[name].slow else scene.starts


def applying(scene):
    """Names of the methods that a scene tells apart."""
    return [name for name in METHODS if scene.components == 4 or name not in NEEDS_CONTACTS]
