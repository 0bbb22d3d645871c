"""Symmetric motions with two impacts in a cycle, of a linear oscillator between rigid walls.

The closed form is from Masri and Caughey, "On the stability of the impact damper", J. Appl. Mech.
33(3), 586-592, 1966. The loose mass flies with the velocities w and -w in turn, with w = s d0. Just
after an impact at Z2 = -d0 the state of the primary mass is the forced response plus w times
`Family.free`; half a cycle later the state has changed its sign.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

# Times in a flight between which changes of sign of a velocity are searched for.
SAMPLES = 200


class Motion(NamedTuple):
    """A motion: clearance, speed of the loose mass, largest |Z1|, multipliers over half a cycle.

    `room` is the smallest distance to a wall within a flight, divided by d0. If it is negative,
    the loose mass would pass through a wall.
    """

    clearance: float
    speed: float
    displacement: float
    multipliers: np.ndarray
    room: float

    @property
    def stable(self):
        """Whether the motion exists and all multipliers are less than 1 in modulus."""
        return bool(self.room > 0 and abs(self.multipliers[0]) < 1)


def two_impact_motions(oscillator, damper, frequency):
    """Return the motions at the damper's clearance, by ascending speed."""
    family = Family(oscillator, damper, frequency)
    square, linear = family.across**2 + family.along**2, family.across
    root = linear**2 - square * (1 - (abs(family.response) / damper.clearance) ** 2)
    ratios = (linear + np.array([-1, 1]) * np.sqrt(root)) / square if root >= 0 else []
    return [family.motion(ratio) for ratio in ratios if ratio > 0]


def flight_with_speed(oscillator, damper, frequency, ratio):
    """Return d0, and phase and state in the middle of the flight after an impact at Z2 = -d0."""
    family = Family(oscillator, damper, frequency)
    clearance, phase, impact = family.impact(ratio)
    parts = family.motions(ratio, clearance, phase, impact)
    return clearance, phase + np.pi / 2, np.concatenate([part(family.half / 2) for part in parts])


class Family:
    """The motions of one oscillator and damper for any ratio s = w/d0."""

    def __init__(self, oscillator, damper, frequency):
        assert oscillator.cubic == 0, "the closed form is for a linear spring"
        self.oscillator, self.damper, self.frequency = oscillator, damper, frequency
        stiffness = oscillator.linear_frequency**2
        dynamic = stiffness - frequency**2 + 1j * oscillator.damping * frequency
        self.response = oscillator.forcing_amplitude(frequency) / dynamic
        self.half = np.pi / frequency
        mass, restitution = damper.mass_ratio, damper.restitution
        self.map = np.eye(4)
        self.map[:2, :2], self.map[2, 3] = self.free_map(self.half), self.half
        self.free = np.linalg.solve(self.map[:2, :2] + np.eye(2), [0, 2 * mass])
        self.before = (1 - restitution + 2 * mass) / (1 + restitution)
        # (across s - 1)^2 + (along s)^2 = |response|^2/d0^2
        self.across = self.half / 2 - self.free[0]
        self.along = (self.before + self.free[1] - 2 * mass) / frequency

    def free_map(self, time):
        """Return the matrix (..., 2, 2) that maps (Z1, Z1') over `time` without forcing."""
        drag, stiffness = self.oscillator.damping / 2, self.oscillator.linear_frequency**2
        turn = np.sqrt(complex(stiffness - drag**2)) * np.asarray(time)
        cosine, sine = np.cos(turn).real, (np.sinc(turn / np.pi) * time).real
        rows = [cosine + drag * sine, sine], [-stiffness * sine, cosine - drag * sine]
        decay = np.exp(-drag * np.asarray(time))[..., None, None]
        return decay * np.moveaxis(np.array(rows), (0, 1), (-2, -1))

    def impact(self, ratio):
        """Return clearance, phase W T of the impact at Z2 = -d0, and the state just before it."""
        position, lag = self.across * ratio - 1, self.along * ratio
        clearance = abs(self.response) / np.hypot(position, lag)
        phase = float(np.angle((position + 1j * lag) / self.response))
        state = [self.half * ratio / 2 - 1, -self.before * ratio, -1, -(1 + self.before) * ratio]
        return clearance, phase, clearance * np.array(state)

    def motions(self, ratio, clearance, phase, impact):
        """Return (Z1, Z1') and (Z2, Z2') as functions of the time since the impact."""
        speed = ratio * clearance

        def primary(time):
            turning = self.response * np.exp(1j * (phase + self.frequency * time))
            forced = np.array([turning.real, -self.frequency * turning.imag])
            return forced + np.moveaxis(self.free_map(time) @ (speed * self.free), -1, 0)

        def relative(time):
            loose = impact[0] + clearance - speed * np.asarray(time)
            return primary(time) - np.array([loose, 0 * loose - speed])

        return primary, relative

    def motion(self, ratio):
        """Return the `Motion` for a ratio s."""
        clearance, phase, impact = self.impact(ratio)
        primary, relative = self.motions(ratio, clearance, phase, impact)
        largest = max([abs(primary(time)[0]) for time in self._turns(primary)] + [abs(impact[0])])
        rooms = [clearance - abs(relative(time)[0]) for time in self._turns(relative)]
        multipliers, room = self._multipliers(impact, phase), min(rooms, default=np.inf) / clearance
        return Motion(clearance, ratio * clearance, largest, multipliers, room)

    def _turns(self, motion):
        """Return the times in a flight at which the velocity of a motion changes its sign."""
        times = np.linspace(0, self.half, SAMPLES)
        speed = motion(times)[1]
        changes = np.flatnonzero(speed[:-1] * speed[1:] < 0)
        return [brentq(lambda t: motion(t)[1], times[k], times[k + 1]) for k in changes]

    def _multipliers(self, impact, phase):
        """Return the multipliers, by descending modulus, from the saltation matrix of an impact.

        The state is (Z1, Z1', x2, x2') with the displacement x2 = Z1 - Z2 of the loose mass.
        """
        mass = self.damper.mass_ratio
        gain = (1 + self.damper.restitution) / (1 + mass)
        jump = np.eye(4)
        jump[1, [1, 3]] += np.array([-1, 1]) * mass * gain
        jump[3, [1, 3]] += np.array([1, -1]) * gain
        state = np.array([*impact[:2], *(impact[:2] - impact[2:])])
        surface = np.array([-1, 0, 1, 0])
        before, after = self._rate(state, phase), self._rate(jump @ state, phase)
        impulse = jump + np.outer(after - jump @ before, surface) / (surface @ before)
        values = np.linalg.eigvals(-self.map @ impulse)
        return values[np.argsort(-np.abs(values), kind="stable")]

    def _rate(self, state, phase):
        """Return the derivative of (Z1, Z1', x2, x2') in flight."""
        force = self.oscillator.forcing_amplitude(self.frequency) * np.cos(phase)
        drag = self.oscillator.damping * state[1] + self.oscillator.linear_frequency**2 * state[0]
        return np.array([state[1], force - drag, state[3], 0])
