"""Motions by heyoka.py, a Taylor integrator, at its fastest settings for this problem.

One heyoka integrator computes flight and contact. Its one event is Z2^2 = d0^2: the loose mass
reaches or leaves a wall. At the event a Python callback switches two parameters, the stiffness of
the contact (0 in flight) and the position of the wall, and the integration continues. The callback
accesses parameters and state through memory views. The views are made only once, since making them
takes longer than the rest of the callback. Two events, one for each wall, are 4 to 8 % slower. Two
integrators in turn, for flight and contact, are slower still, because `propagate_until` returns at
every event. Every run of the benchmarks also times the other settings in `SETTINGS`.
"""

import math

import heyoka
import numpy as np

from benchmarks.rivals import coefficients
from impact_damper.model import packed

FASTEST = {"fast_math": True, "force_avx512": True}
# Trajectories of a batch. Of the numbers tried, 8 to 64, 16 is the fastest.
BATCH = 16
# Time after an event in which heyoka does not search for the event again. With heyoka's default
# the end of a very short contact is missed, at tolerances down to 1e-10; with 0 an event is found a
# second time.
COOLDOWN = 1e-9
# Changes of the fastest settings, one at a time.
SETTINGS = {
    "fast_math off": {"fast_math": False},
    "force_avx512 off": {"force_avx512": False},
    "slp_vectorize on": {"slp_vectorize": True},
    "compact_mode on": {"compact_mode": True},
    "high_accuracy on": {"high_accuracy": True},
    "opt_level 2": {"opt_level": 2},
    "forcing as cos(W T)": {"linear_forcing": False},
}


class Motions:
    """A heyoka integrator for given parameters.

    The equations omit factors that are 1, such as the cubic coefficient and the force of the paper,
    and contain parameters as numbers. `batch` is the number of trajectories integrated together.
    With `linear_forcing` the forcing comes from two additional linear equations, not from a cosine.
    `settings`, keywords of heyoka, override `FASTEST`.
    """

    def __init__(self, p, tolerance, *, batch=1, linear_forcing=True, **settings):
        self.batch, self.damped = batch, p[packed.CLEARANCE] < math.inf
        self.views = [None, None]
        x, v, z, w, c, s = heyoka.make_vars("x", "v", "z", "w", "c", "s")
        damping, stiffness, cubic, amplitude, frequency, *walls = coefficients(p)
        clearance, wall, dashpot, heavy = walls
        forcing = c if linear_forcing else heyoka.cos(frequency * heyoka.time)
        if not linear_forcing and amplitude != 1:
            forcing = amplitude * forcing
        free = forcing - damping * v - (x * x * x if cubic == 1 else cubic * (x * x * x))
        if stiffness != 0:
            free -= stiffness * x
        system, events = [(x, v), (v, free)], []
        if self.damped:
            depth = z - heyoka.par[1]
            force = heyoka.par[0] * (depth + dashpot / wall * w if dashpot > 0 else depth)
            system = [(x, v), (v, free - force), (z, w), (w, free - heavy * force)]
            event = heyoka.t_event if batch == 1 else heyoka.t_event_batch
            callback = self._callback(clearance, wall)
            events = [event(z * z - clearance**2, callback=callback, cooldown=COOLDOWN)]
        if linear_forcing:
            system += [(c, -frequency * s), (s, frequency * c)]
        self.begin = [amplitude * math.cos(0.5 * math.pi), amplitude] if linear_forcing else []
        state, pars = np.zeros(len(system)), np.zeros(2 * self.damped)
        make = heyoka.taylor_adaptive
        if batch > 1:
            make = heyoka.taylor_adaptive_batch
            state, pars = (np.repeat(each[:, None], batch, axis=1) for each in (state, pars))
        settings = FASTEST | settings
        self.motion = make(system, state, pars=pars, t_events=events, tol=tolerance, **settings)
        self.state, self.pars = self.motion.state, self.motion.pars
        self.views[:] = memoryview(self.pars), memoryview(self.state)

    def _callback(self, clearance, stiffness):
        """Return the callback that switches the contact on and off through `self.views`."""
        views = self.views

        def scalar(_, sign):
            pars, state = views
            if sign > 0:
                pars[0] = stiffness
                pars[1] = clearance if state[2] > 0 else -clearance
            else:
                pars[0] = 0.0
            return True

        def batched(_, sign, i):
            pars, state = views
            if sign > 0:
                pars[0, i] = stiffness
                pars[1, i] = clearance if state[2, i] > 0 else -clearance
            else:
                pars[0, i] = 0.0
            return True

        return scalar if self.batch == 1 else batched

    def _start(self, columns):
        """Start in flight at the states `columns`; return the number of components of a state."""
        n = 4 if self.damped else 2
        self.state[:n] = columns[:n]
        for i, value in enumerate(self.begin):
            self.state[n + i] = value
        if self.damped:
            self.pars[0] = 0.0
            self.motion.reset_cooldowns()
        return n

    def run(self, scene, starts):
        """Return the states at the scene's end, shape (m, 4); NaN where a run failed.

        The number of starts m must be a multiple of the batch.
        """
        motion, ended = self.motion, heyoka.taylor_outcome.time_limit
        states = np.full((len(starts), 4), np.nan)
        if self.batch == 1:
            for i, start in enumerate(starts):
                n = self._start(start)
                motion.time = scene.begin
                if motion.propagate_until(scene.end)[0] == ended:
                    states[i, :n] = self.state[:n]
            return states
        for i in range(0, len(starts), self.batch):
            n = self._start(starts[i : i + self.batch].T)
            motion.set_time(scene.begin)
            motion.propagate_until(scene.end)
            if all(outcome[0] == ended for outcome in motion.propagate_res):
                states[i : i + self.batch, :n] = self.state[:n].T
        return states
