"""Closed forms for the optimum clearance: the quiet motion as flights between two impacts.

While the displacement is small the cubic spring does not count, and the primary mass is a linear
oscillator under the forcing and two impulses a period. The walls may be rigid or stiff, impacts
elastic or not. Two optima of rm W^2 d0 follow: that of the least max |Z1|, and that of the least
first harmonic of Z1.
"""

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.system.parameters import check_damper, check_number

GRID = 65
# q and the phase of the turning point where both displacements are equal, for straight flights
# without losses: q - 1 = cos(phi) - q + 2 q phi/pi with sin(phi) = 2 q/pi.
IMPULSE, TURN = 1.1382168528663819, 0.8104702831754177
NEWTON_STEPS = 3
# Two roots of the free oscillator that coincide are taken this little apart.
APART = 1e-20j


class Flight(NamedTuple):
    """The quiet motion near its optimum, in units of 1/W^2 for lengths and W T for time.

    Let x be W^2 Z1, and phi the phase behind a peak of -x in the response to the forcing alone,
    -A cos(phi). The loose mass flies straight and is turned back at each wall, W^2 x2 =
    -(q/rm) (1 - 2 (phi - s)/pi) for half a period from an impact at the lag s on, and mirrored
    for the other half. Its impulses of 4 q/pi on the primary mass leave there q R(y),

        x = -A cos(phi) + q R(y),      y = pi/2 - (phi - s),  |y| <= pi/2,

    where R is the periodic response of x'' + g x' + l^2 x to alternating impulses 4/pi; R = 2 y/pi
    for g = l = 0. Three things close the problem.

    Lag. In an elastic impact the mean approach speed is zero, with restitution it is (1 - e)/
    (1 + e) of half its jump. Hence A sin(s) = q L, where L is (2/pi) (1 + 1/rm) (1 - e)/(1 + e)
    plus what damping takes, (2/pi) tanh(pi g/2) for l = 0.

    Walls. The gap at an impact gives rm W^2 d0 = q + rm x(s) for rigid walls. An elastic contact
    takes the phase pi k, k = W/sqrt(r1 (1 + 1/rm)), one with the damping ratio z of the pair
    theta = pi k/sqrt(1 - z^2). The straight lines before and after it, of approach speeds v and
    e v, meet beyond the wall by v theta e/(1 + e): the motion is that between rigid walls further
    out, which takes (1 + rm) q (4/pi) theta e/(1 + e)^2 off rm W^2 d0, for e = 1 (1 + rm) q k. The
    forcing during a contact takes theta (1 - e)/(1 + e) - 2 z k off the lag.

    Tip. In a contact of finite duration x turns before the lines meet: it stays below by the
    share 1 - 2/pi of that distance, by which a half sine stays below its end tangents.

    Stiffness l and damping g are exact in this for rigid walls. What k leaves is of the orders k^2,
    so 1/r1, and k g; with e < 1 also a small part of the tip's rounding, of order (1 - e) k. The
    cubic spring is left out: near an optimum it adds about (3/4) max |Z1|^2/W^2 to l^2, and the
    clearance is off by about that share.

    Attributes
    ----------
    mass_ratio, restitution : float
        rm and e.
    contact : float
        k, the phase of an elastic contact over pi; 0 for rigid walls.
    damping : float
        g = h/W.
    stiffness : float
        l = omega_l/W, below 1.
    """

    mass_ratio: float
    restitution: float = 1.0
    contact: float = 0.0
    damping: float = 0.0
    stiffness: float = 0.0

    @property
    def forced(self):
        """A, the amplitude of the response to the forcing alone."""
        return 1 / np.hypot(1 - self.stiffness**2, self.damping)

    @property
    def forced_lag(self):
        """Phase of the forcing's peak behind phi = 0."""
        return np.arctan2(self.damping, 1 - self.stiffness**2)

    @property
    def loss(self):
        """L/A, so that sin(s) = q L/A for rigid walls."""
        impact = (1 + 1 / self.mass_ratio) * (1 - self.restitution) / (1 + self.restitution)
        damping = self._difference(lambda root: root * np.tanh(np.pi * root / 2))
        return 2 / np.pi * (impact - damping) / self.forced

    @property
    def contact_damping(self):
        """z, the damping ratio of the two masses in contact."""
        return -np.log(self.restitution) / np.hypot(np.pi, np.log(self.restitution))

    @property
    def contact_phase(self):
        """theta, the phase that a contact takes."""
        return np.pi * self.contact / np.sqrt(1 - self.contact_damping**2)

    @property
    def reach(self):
        """How far beyond the wall the lines of a contact meet, over (1 + 1/rm) q."""
        return 4 / np.pi * self.contact_phase * self.restitution / (1 + self.restitution) ** 2

    @property
    def setback(self):
        """What a contact of finite duration takes off the lag."""
        share = (1 - self.restitution) / (1 + self.restitution)
        return self.contact_phase * share - 2 * self.contact_damping * self.contact

    @property
    def most(self):
        """An impulse q beyond which there is no flight, or no turning point in it."""
        bound = np.pi / 2 * self.forced
        return min(bound, 1 / self.loss) if self.loss > 0 else bound

    def lag(self, impulse):
        """s for an impulse q."""
        return np.arcsin(np.minimum(self.loss * impulse, 1.0)) - self.setback

    def _difference(self, function):
        """Divided difference of a function over the two roots of the free oscillator."""
        half = np.sqrt(complex(self.damping**2 / 4 - self.stiffness**2)) or APART
        roots = -self.damping / 2 + half, -self.damping / 2 - half
        return ((function(roots[0]) - function(roots[1])) / (2 * half)).real

    def motion(self, phase, impulse):
        """x and its first two derivatives at a phase between an impact and the next."""
        y = np.pi / 2 - (phase - self.lag(impulse))
        pushed = [
            -2
            / np.pi
            * self._difference(
                lambda root, n=n: root**n * np.exp(-root * y) / np.cosh(np.pi * root / 2)
            )
            for n in range(3)
        ]
        wave = np.cos(phase), -np.sin(phase), -np.cos(phase)
        return tuple(
            impulse * push - self.forced * each for push, each in zip(pushed, wave, strict=True)
        )

    def ratio(self, impulse):
        """rm W^2 d0 for an impulse q."""
        tip = self.motion(self.lag(impulse), impulse)[0]
        return impulse + self.mass_ratio * tip - (1 + self.mass_ratio) * self.reach * impulse

    def largest(self, impulse):
        """max |x| for an impulse q: at the rounded tip, or at a turning point between impacts.

        Newton's method finds the turning points from where they are for g = l = 0.
        """
        lag = self.lag(impulse)
        turn = np.arcsin(np.minimum(2 * impulse / (np.pi * self.forced), 1.0))
        sizes = [self.motion(lag, impulse)[0] - (1 - 2 / np.pi) * self.reach * impulse]
        for phase in (turn, np.pi - turn):
            for _ in range(NEWTON_STEPS):
                _, slope, bend = self.motion(phase, impulse)
                phase = np.clip(phase - slope / bend, lag, lag + np.pi)
            sizes.append(self.motion(phase, impulse)[0])
        return np.max(np.abs(sizes), axis=0)


def flight_of(oscillator, damper, frequency) -> Flight:
    """The flight of the loose mass of a damper, whatever its clearance.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
        W, above omega_l.

    Raises
    ------
    TypeError
        If `damper` is not a Damper.
    ValueError
        If the frequency is not above the linear one.
    """
    check_damper(damper)
    frequency = check_number(
        "frequency",
        frequency,
        above=oscillator.linear_frequency,
        why="below the linear frequency a small motion follows its forcing",
    )
    return Flight(
        damper.mass_ratio,
        damper.restitution,
        frequency / np.sqrt(damper.contact_stiffness * (1 + 1 / damper.mass_ratio)),
        oscillator.damping / frequency,
        oscillator.linear_frequency / frequency,
    )


@cache
def least_displacement_ratio(flight) -> float:
    """rm W^2 d0 at which max |Z1| is least.

    With Lambda = (1 + 1/rm) (1 - e)/(1 + e) and rigid walls, no damping and no stiffness, it is
    (1 + rm) q - rm cos(s) in two regimes. Up to Lambda = 0.369 the displacement at an impact
    equals that between impacts, a kink: q = 1.1382, s = 0 for e = 1. Beyond, that between impacts
    has a smooth minimum of its own, where Lambda cos(s + tan(s)) = sin(s) and q = pi sin(s)/
    (2 Lambda).
    """
    impulses = np.linspace(0, flight.most, GRID + 2)[1:-1]
    best = int(np.argmin(flight.largest(impulses)))
    bounds = impulses[max(best - 1, 0)], impulses[min(best + 1, GRID - 1)]
    found = minimize_scalar(
        flight.largest, bounds=bounds, method="bounded", options={"xatol": 1e-10}
    )
    return float(flight.ratio(found.x))


def least_harmonic_ratio(flight) -> float:
    """rm W^2 d0 at which the first harmonic of Z1 is least; closed.

    The harmonic is the response to that of forcing and impulses together, 1 - c q exp(-i p) with
    c = 8/pi^2 and p the lag of an impact behind the forcing. Its modulus is least where, of the
    angle u whose sine is q L/A and n = u - p, tan(2 u) = 2 cos(n)/(c A/L - 2 sin(n)). For e = 1
    without damping q = pi^2/8, and with rigid walls rm W^2 d0 = (1 + rm) pi^2/8 - rm: the mass
    that flies through 8/pi^2 of the gap, as if Z1 stood still, is the limit of a small rm.
    """
    share = 8 / np.pi**2
    loss = flight.loss
    if loss == 0:
        return float(flight.ratio(1 / share))
    shift = flight.forced_lag + flight.setback
    angle = np.arctan2(2 * loss * np.cos(shift), share - 2 * loss * np.sin(shift)) / 2
    return float(flight.ratio(np.sin(angle) / loss))


def elastic_ratios(flight) -> tuple[float, float]:
    """Both optima for elastic contact, explicit: of first order in k and g, and without stiffness.

    rm W^2 d0 = (1 + rm) (1.138 - 0.860 k + 0.095 g) - rm for the least max |Z1|, and
    (1 + rm) (1 - k) pi^2/8 - rm for the least first harmonic; NaN for e < 1.
    """
    if flight.restitution != 1:
        return np.nan, np.nan
    contact, damping, whole = flight.contact, flight.damping, 1 + flight.mass_ratio
    bend = (2 * IMPULSE - TURN * (np.pi - TURN)) / np.pi * damping
    kink = 1 + ((1 - 2 / np.pi) * contact + bend) / (2 - 2 * TURN / np.pi)
    displacement = whole * IMPULSE * (kink - contact) - flight.mass_ratio
    harmonic = whole * (1 - contact) * np.pi**2 / 8 - flight.mass_ratio
    return displacement, harmonic
