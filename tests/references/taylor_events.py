"""Motions by heyoka.py with terminal events, independent of the package's integrators (kernels).

State and parameters are the same as for the kernels: (Z1, Z1', Z2, Z2') and the packed parameters
of `model.packed.pack`.
"""

import math
from typing import NamedTuple

import heyoka
import numpy as np

from impact_damper.model import packed
from references import equation

# Larger clearances are replaced by this one. heyoka's tolerance is relative to the largest term of
# the events, so a distant wall would make the integration inaccurate.
BEYOND_ALL_MOTIONS = 16.0
# Number of parameters in flight (False) and in contact (True). The parameters in flight come first,
# and the wall in contact is the last parameter.
PARAMETERS = {False: packed.CLEARANCE + 1, True: packed.COUNT + 1}


class Run(NamedTuple):
    """States (n, 4) at given times, and contacts (k, 5): wall, beginning, end, Z2' at both."""

    states: np.ndarray
    contacts: np.ndarray


def systems_and_events():
    """Return heyoka's equations and terminal events in flight (False) and in contact (True)."""
    x, v, z, w = heyoka.make_vars("x", "v", "z", "w")
    *p, side = [heyoka.par[i] for i in range(packed.COUNT + 1)]
    free = equation.flight(p, x, v, heyoka.cos(p[packed.FREQUENCY] * heyoka.time))
    force = equation.contact(p, side, z, w)
    clearance, inverse_mass = p[packed.CLEARANCE], p[packed.INVERSE_MASS_RATIO]
    rising, falling = heyoka.event_direction.positive, heyoka.event_direction.negative
    entries = [
        heyoka.t_event(z - clearance, direction=rising),
        heyoka.t_event(z + clearance, direction=falling),
    ]
    separation = [heyoka.t_event(side * z - clearance, direction=falling)]
    pushed = [(x, v), (v, free - force), (z, w), (w, free - force - inverse_mass * force)]
    systems = {False: [(x, v), (v, free), (z, w), (w, free)], True: pushed}
    return systems, {False: entries, True: separation}


class Reference:
    """Integrator that switches between flight and contact at terminal events."""

    def __init__(self):
        systems, events = systems_and_events()
        self.integrators = {
            touching: heyoka.taylor_adaptive(
                system, np.zeros(4), pars=np.zeros(PARAMETERS[touching]), t_events=events[touching]
            )
            for touching, system in systems.items()
        }

    def _leg(self, p, side, state, t, end):
        """Integrate to the next event or to the end; return outcome, state and time."""
        motion = self.integrators[side != 0]
        motion.time = t
        motion.state[:] = state
        motion.reset_cooldowns()
        motion.pars[:] = np.append(p, side)[: len(motion.pars)]
        motion.pars[packed.CLEARANCE] = min(p[packed.CLEARANCE], BEYOND_ALL_MOTIONS)
        outcome = motion.propagate_until(end)[0]
        return outcome, motion.state.copy(), motion.time

    def run(self, p, state, start, times, side=0):
        """Integrate from `start` through increasing times; `side` is the first wall in contact."""
        t, clearance = start, min(p[packed.CLEARANCE], BEYOND_ALL_MOTIONS)
        contacts = [[side, t, np.nan, state[3], np.nan]] if side else []
        samples = []
        while len(samples) < len(times):
            outcome, state, t = self._leg(p, side, state, t, times[len(samples)])
            if outcome == heyoka.taylor_outcome.time_limit:
                samples.append(state)
                continue
            wall = side or (1 if int(outcome) == -1 else -1)
            if side:
                contacts[-1][2::2] = t, state[3]
                side = 0
            else:
                contacts.append([wall, t, np.nan, state[3], np.nan])
                side = wall
            # On the wall itself heyoka could miss a separation within the same step.
            state[2] = wall * np.nextafter(clearance, math.inf if side else 0.0)
        return Run(np.array(samples), np.array(contacts).reshape(-1, 5))
