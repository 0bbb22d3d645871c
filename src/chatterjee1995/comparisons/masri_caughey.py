"""Symmetric motions with two impacts in a cycle, for an impact damper on a linear oscillator.

The closed form is from Masri and Caughey, "On the stability of the impact damper", J. Appl. Mech.
33(3), 586-592, 1966. The walls are rigid, and an impact takes no time. Half a cycle after an impact
at one wall, the mirror image of this impact follows at the other wall. Between impacts the loose
mass flies at constant velocity, alternately w and -w. Z1 is the displacement of the primary mass,
Z2 the displacement of the primary mass relative to the loose mass, and W the forcing frequency.

Let d0 be the clearance, e the restitution and rm the mass ratio. The loose mass meets the wall Z2 =
-d0 with the velocity w and leaves it with the velocity -w. Momentum and restitution give the
velocity of the primary mass before this impact, -k w with k = (1 - e + 2 rm)/(1 + e). The flight
gives the displacement of the primary mass at the impact, pi w/(2 W) - d0. Between impacts the state
of the primary mass is the sum of the steady forced response and a transient, which is a decaying
unforced oscillation. The transient is w (a, b) just before the impact and w (a, b + 2 rm) just
after it. By symmetry it has changed its sign half a cycle later,

    M (a, b + 2 rm) = -(a, b),

where M is the map of the unforced oscillator over half a cycle. The state before the impact minus
w (a, b) is the forced response, whose amplitude A is known:

    (pi w/(2 W) - d0 - w a)^2 + (w (k + b)/W)^2 = A^2.

With the ratio s = w/d0 this equation gives d0 for every s. For a given d0 it is quadratic in w.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.model.checks import check_frequency
from impact_damper.model.parameters import check_damper, check_oscillator

# Number of times in a flight at which a velocity is computed. Its changes of sign bracket the
# turning points.
SAMPLES = 200


class TwoImpactMotion(NamedTuple):
    """A symmetric motion with two impacts in a forcing cycle, stable or unstable.

    Attributes
    ----------
    clearance : float
        d0.
    speed : float
        w, speed of the loose mass between impacts.
    phase : float
        W T of the impact at the wall Z2 = -d0, in (-pi, pi].
    impact : numpy.ndarray, shape (4,)
        Z1, Z1', Z2, Z2' just before the impact at the wall Z2 = -d0.
    displacement : float
        max |Z1|.
    multipliers : numpy.ndarray of complex, shape (4,)
        Multipliers of the map over half a cycle followed by a change of sign, by descending
        modulus. A multiplier 1 indicates a fold, and -1 a loss of symmetry. The multipliers of the
        motion over a whole cycle are the squares of these numbers.
    room : float
        Smallest distance to a wall at the turning points of Z2 during a flight, divided by d0;
        infinite without such points. If it is negative, the solution of the equations is no motion,
        because the loose mass would pass through a wall.
    """

    clearance: float
    speed: float
    phase: float
    impact: np.ndarray
    displacement: float
    multipliers: np.ndarray
    room: float

    @property
    def stable(self) -> bool:
        """True if the solution is a motion and all multipliers are less than 1 in modulus."""
        return bool(self.room > 0 and abs(self.multipliers[0]) < 1)


class Flight(NamedTuple):
    """The state in the middle of the flight of the loose mass from the wall Z2 = -d0.

    Attributes
    ----------
    clearance : float
        d0.
    phase : float
        W T in the middle of the flight, a quarter of a cycle after the impact.
    state : numpy.ndarray, shape (4,)
        Z1, Z1', Z2, Z2' at this phase.
    """

    clearance: float
    phase: float
    state: np.ndarray


def two_impact_motions(oscillator, damper, frequency) -> list[TwoImpactMotion]:
    """Return all symmetric motions with two impacts in a cycle, by ascending speed w.

    Parameters
    ----------
    oscillator : Oscillator
        Its spring must be linear.
    damper : Damper
        Its contact stiffness has no effect, because the walls are rigid.
    frequency : float
        W.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range, or the spring is not linear.
    """
    family = Family(oscillator, damper, frequency)
    square, linear = family.across**2 + family.along**2, family.across
    root = linear**2 - square * (1 - (abs(family.response) / damper.clearance) ** 2)
    ratios = (linear + np.array([-1, 1]) * np.sqrt(root)) / square if root >= 0 else []
    return [family.motion(ratio) for ratio in ratios if ratio > 0]


def flight_with_speed(oscillator, damper, frequency, ratio) -> Flight:
    """Return the middle of the flight of the motion with a given ratio s = w/d0.

    Parameters
    ----------
    oscillator, damper, frequency
        As in `two_impact_motions`, but the clearance of the damper has no effect.
    ratio : float
        s = w/d0.
    """
    family = Family(oscillator, damper, frequency)
    clearance, phase, impact = family.impact(ratio)
    primary, relative = family.motions(ratio, clearance, phase, impact)
    middle = family.half / 2
    state = np.concatenate([primary(middle), relative(middle)])
    return Flight(clearance, phase + np.pi / 2, state)


class Family:
    """The motions of one oscillator and damper over half a cycle, for any ratio s = w/d0.

    Attributes
    ----------
    frequency : float
        W.
    response : complex
        Amplitude of the forced response without a damper.
    free : numpy.ndarray, shape (2,)
        a and b + 2 rm: the transient after an impact, divided by w.
    across, along : float
        Coefficients of (across s - 1)^2 + (along s)^2 = |response|^2/d0^2.
    """

    def __init__(self, oscillator, damper, frequency):
        check_oscillator(oscillator)
        oscillator.check_linear("(closed form of a linear spring)")
        check_damper(damper)
        self.oscillator, self.damper = oscillator, damper
        self.frequency = check_frequency(frequency)
        stiffness = oscillator.linear_frequency**2
        force = oscillator.forcing_amplitude(self.frequency)
        dynamic = stiffness - self.frequency**2 + 1j * oscillator.damping * self.frequency
        self.response = force / dynamic
        self.half = np.pi / self.frequency
        mass, restitution = damper.mass_ratio, damper.restitution
        self._whole_map = np.eye(4)
        self._whole_map[:2, :2], self._whole_map[2, 3] = self.free_map(self.half), self.half
        self.free = np.linalg.solve(self._whole_map[:2, :2] + np.eye(2), [0, 2 * mass])
        self.before = (1 - restitution + 2 * mass) / (1 + restitution)
        self.across = self.half / 2 - self.free[0]
        self.along = (self.before + self.free[1] - 2 * mass) / self.frequency

    def free_map(self, time):
        """Return the matrix, shape (..., 2, 2), that maps (Z1, Z1') over a time without forcing."""
        drag, stiffness = self.oscillator.damping / 2, self.oscillator.linear_frequency**2
        turn = np.sqrt(complex(stiffness - drag**2)) * np.asarray(time)
        cosine, sine = np.cos(turn).real, (np.sinc(turn / np.pi) * time).real
        rows = [cosine + drag * sine, sine], [-stiffness * sine, cosine - drag * sine]
        return np.exp(-drag * np.asarray(time))[..., None, None] * np.moveaxis(
            np.array(rows), (0, 1), (-2, -1)
        )

    def motion(self, ratio) -> TwoImpactMotion:
        """Return the motion for a ratio s = w/d0."""
        clearance, phase, impact = self.impact(ratio)
        primary, relative = self.motions(ratio, clearance, phase, impact)
        turns = [abs(primary(time)[0]) for time in self._turns(primary)]
        return TwoImpactMotion(
            clearance,
            ratio * clearance,
            phase,
            impact,
            max([*turns, abs(impact[0])]),
            self._multipliers(impact, phase),
            self._room(relative, clearance),
        )

    def is_stable(self, ratio) -> bool:
        """Return `TwoImpactMotion.stable` for a ratio s, without computing the whole motion."""
        clearance, phase, impact = self.impact(ratio)
        if abs(self._multipliers(impact, phase)[0]) >= 1:
            return False
        return self._room(self.motions(ratio, clearance, phase, impact)[1], clearance) > 0

    def impact(self, ratio):
        """Return clearance d0, phase W T and state just before the impact at Z2 = -d0."""
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

    def _room(self, relative, clearance):
        """Return `TwoImpactMotion.room` for the motion `relative` of (Z2, Z2')."""
        rooms = [clearance - abs(relative(time)[0]) for time in self._turns(relative)]
        return min(rooms, default=np.inf) / clearance

    def _turns(self, motion):
        """Return the times in a flight at which the velocity of a motion changes its sign."""
        times = np.linspace(0, self.half, SAMPLES)
        speed = motion(times)[1]
        changes = np.flatnonzero(speed[:-1] * speed[1:] < 0)
        return [brentq(lambda t: motion(t)[1], times[k], times[k + 1]) for k in changes]

    def _multipliers(self, impact, phase):
        """Return the multipliers of an impact and the following flight, with a change of sign.

        In the coordinates y = (Z1, Z1', x2, x2'), with the displacement x2 = Z1 - Z2 of the loose
        mass, the impact at the wall n y = d0 is a linear map y -> J y. A disturbance also shifts
        the time of the impact. Let f_before and f_after be the time derivatives of y before and
        after the impact. The derivative of the impact map, with the shift in time, is
        J + (f_after - J f_before) n/(n f_before).
        """
        mass, restitution = self.damper.mass_ratio, self.damper.restitution
        gain = (1 + restitution) / (1 + mass)
        jump = np.eye(4)
        jump[1, [1, 3]] += np.array([-1, 1]) * mass * gain
        jump[3, [1, 3]] += np.array([1, -1]) * gain
        state = np.array([*impact[:2], *(impact[:2] - impact[2:])])
        surface = np.array([-1, 0, 1, 0])
        before, after = self._rate(state, phase), self._rate(jump @ state, phase)
        impulse = jump + np.outer(after - jump @ before, surface) / (surface @ before)
        values = np.linalg.eigvals(-self._whole_map @ impulse)
        return values[np.argsort(-np.abs(values), kind="stable")]

    def _rate(self, state, phase):
        """Return the derivative of (Z1, Z1', x2, x2') in flight."""
        oscillator = self.oscillator
        force = oscillator.forcing_amplitude(self.frequency) * np.cos(phase)
        drag = oscillator.damping * state[1] + oscillator.linear_frequency**2 * state[0]
        return np.array([state[1], force - drag, state[3], 0])
