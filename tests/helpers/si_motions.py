"""Motions of a machine with a damper in SI units, by SciPy with contacts located as events."""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


class SiMotion:
    """A machine, with or without a damper, under a given force."""

    def __init__(self, machine, damper, force):
        self.machine, self.damper, self.force = machine, damper, force
        self.clearance = damper.gap / 2 if damper else math.inf
        self.dashpot = 0.0
        if damper:
            # Walls never pull, so e = exp(-(pi - 2 a) tan a) with the damping ratio sin a.
            logarithm = math.log(damper.restitution)
            ratio = math.sin(brentq(lambda a: (math.pi - 2 * a) * math.tan(a) + logarithm, 0, 1.5))
            mass = damper.mass * machine.mass / (damper.mass + machine.mass)
            self.dashpot = 2 * ratio * math.sqrt(damper.contact_stiffness * mass)

    def push(self, y, wall):
        """Return the force of the wall in contact, N."""
        if not wall:
            return 0.0
        depth = wall * y[2] - self.clearance
        return max(0.0, self.damper.contact_stiffness * depth + self.dashpot * wall * y[3])

    def slope(self, t, y, wall):
        """Return the time derivative of y: four components of a state, and the loss in contacts."""
        machine, push, force = self.machine, self.push(y, wall), self.force(t)
        loss = machine.viscous_damping * y[1]
        spring = machine.linear_stiffness * y[0] + machine.cubic_stiffness * y[0] ** 3
        a = (force - spring - loss - wall * push) / machine.mass
        loose = wall * push / self.damper.mass if wall else 0.0
        return [y[1], a, y[3], a - loose, self.dashpot * y[3] ** 2 if push else 0.0]

    def run(self, state, begin, end, *, longest=5e-3, in_contact=2e-4):
        """Yield each flight and each contact as (wall, solution).

        The wall is 1 or -1, and 0 in flight. `solve_ivp` returns the solution. `longest` is the
        largest step in flight, s, `in_contact` the largest step in contact, s. The second event
        records the times at which the velocity of the machine changes sign.
        """

        def reached(t, y, wall):
            if not wall:
                return abs(y[2]) - self.clearance
            depth = wall * y[2] - self.clearance
            return self.damper.contact_stiffness * depth + self.dashpot * wall * y[3]

        def turned(t, y, wall):
            return y[1]

        reached.terminal = True
        t, wall, y = begin, 0, np.concatenate([state, [0.0]])
        while t < end:
            reached.direction = -1 if wall else 1
            solution = solve_ivp(
                self.slope,
                (t, end),
                y,
                method="DOP853",
                events=(reached, turned) if self.damper else (lambda t, y, wall: 1.0, turned),
                args=(wall,),
                rtol=1e-12,
                atol=1e-14,
                max_step=in_contact if wall else longest,
                dense_output=True,
            )
            yield wall, solution
            t, y = solution.t[-1], solution.y[:, -1]
            if solution.status == 1:
                wall = 0 if wall else int(np.sign(y[2]))
