"""Rigid impacts located by SciPy's events, as an independent reference."""

import numpy as np
from references import equation
from scipy.integrate import solve_ivp

from impact_damper.model.packed import pack

TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12}


def flight_rate(oscillator, frequency):
    """Return the function (t, y) -> y' of the state y = (Z1, Z1', x2, x2') in flight."""

    p = pack(oscillator, None, frequency)

    def rate(t, y):
        return [y[1], equation.flight(p, y[0], y[1], np.cos(frequency * t)), y[3], 0.0]

    return rate


def events_of(oscillator, damper, frequency, state, begin, end):
    """Return the state at `end` and the impacts (time, wall), by SciPy.

    The state is (Z1, Z1', x2, x2') with x2 = Z1 - Z2.
    """

    def wall(sign):
        def event(t, y):
            return sign * (y[0] - y[2]) - damper.clearance

        event.terminal, event.direction = True, 1
        return event

    rate, walls = flight_rate(oscillator, frequency), [wall(1), wall(-1)]
    share = (1 + damper.restitution) / (1 + damper.mass_ratio)
    impacts, time, state = [], begin, np.array(state, float)
    while time < end:
        found = solve_ivp(rate, (time, end), state, events=walls, **TIGHT)
        time, state = found.t[-1], found.y[:, -1].copy()
        if found.status == 1:
            which = 0 if len(found.t_events[0]) else 1
            impacts.append((time, (1, -1)[which]))
            speed = state[1] - state[3]
            state[1] -= damper.mass_ratio * share * speed
            state[3] += share * speed
    return state, impacts
