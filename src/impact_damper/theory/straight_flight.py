"""The optimum clearance in closed form, for a loose mass at constant speed from wall to wall.

Lengths are divided by f/W^2 with the forcing amplitude f. Clearances are given as rm W^2 d0/f.
"""

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.model.bounds import check_number
from impact_damper.model.exit_rules import damping_ratio
from impact_damper.model.parameters import check_closed_form

# The search for the smallest max |Z1| tries this number of impulses, then refines the best.
GRID = 65
NEWTON_STEPS = 3
# Shift of two equal roots in `Flight._difference`, to avoid a division by 0.
APART = 1e-20j


class Flight(NamedTuple):
    """The quiet (small) motion near the optimum clearance.

    Impacts and a forcing of the amplitude f drive x = W^2 Z1/f. Phases phi count from the minimum
    that x would have without impacts. At the phase phi = s an impact changes dx/dphi by 4 q/pi. The
    number q is called `impulse`. An elastic contact lasts the time t, and `contact` is W t/pi.
    `damping` is h/W. `stiffness` is wl/W, below 1. See docs/explanation/straight_flight.md.
    """

    mass_ratio: float
    restitution: float = 1.0
    contact: float = 0.0
    damping: float = 0.0
    stiffness: float = 0.0

    @property
    def forced(self):
        """Amplitude A of x = W^2 Z1/f without impacts, where f is the forcing amplitude."""
        return 1 / np.hypot(1 - self.stiffness**2, self.damping)

    @property
    def forced_lag(self):
        """Phase from the minimum of Z1 without impacts to the maximum of the forcing."""
        return np.arctan2(self.damping, 1 - self.stiffness**2)

    @property
    def loss(self):
        """Quotient sin(s)/q of an impact at rigid walls: s is its phase, q its impulse."""
        impact = (1 + 1 / self.mass_ratio) * (1 - self.restitution) / (1 + self.restitution)
        damping = self._difference(lambda root: root * np.tanh(np.pi * root / 2))
        return 2 / np.pi * (impact - damping) / self.forced

    @property
    def contact_phase(self):
        """Duration of a contact times W."""
        return np.pi * self.contact / np.sqrt(1 - damping_ratio(self.restitution) ** 2)

    @property
    def reach(self):
        """Number c: as a contact takes time, the clearance rm W^2 d0/f is lower by (1 + rm) c q.

        f is the forcing amplitude, q the `impulse`. Contacts with rigid walls take no time: c = 0.
        """
        return 4 / np.pi * self.contact_phase * self.restitution / (1 + self.restitution) ** 2

    @property
    def setback(self):
        """Phase of an impact at rigid walls, minus the phase at walls of finite stiffness."""
        asymmetry = (1 - self.restitution) / (1 + self.restitution)
        return self.contact_phase * asymmetry - 2 * damping_ratio(self.restitution) * self.contact

    @property
    def largest_impulse(self):
        """Largest `impulse` q for which the formulas of this class hold."""
        bound = np.pi / 2 * self.forced
        return min(bound, 1 / self.loss) if self.loss > 0 else bound

    def lag(self, impulse):
        """Return the phase s of an impact with `impulse` q."""
        return np.arcsin(np.minimum(self.loss * impulse, 1.0)) - self.setback

    def _difference(self, function):
        # Roots z of z^2 + damping z + stiffness^2 = 0. `half` is half of the roots' difference.
        half = np.sqrt(complex(self.damping**2 / 4 - self.stiffness**2)) or APART
        roots = -self.damping / 2 + half, -self.damping / 2 - half
        return ((function(roots[0]) - function(roots[1])) / (2 * half)).real

    def motion(self, phase, impulse):
        """Return x = W^2 Z1/f (f: forcing amplitude), dx/dphi, d2x/dphi2 at phi = `phase`."""
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
        pairs = zip(pushed, wave, strict=True)
        return tuple(impulse * push - self.forced * each for push, each in pairs)

    def ratio(self, impulse):
        """Return the clearance as rm W^2 d0/f (f: forcing amplitude) for impacts with `impulse`."""
        tip = self.motion(self.lag(impulse), impulse)[0]
        return impulse + self.mass_ratio * tip - (1 + self.mass_ratio) * self.reach * impulse

    def largest_displacement(self, impulse):
        """Return the largest |Z1| W^2/f (f: forcing amplitude), at an impact or a turning point."""
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
    """Return the `Flight` for a damper. The clearance of the damper is not used."""
    check_closed_form(oscillator, damper)
    if oscillator.forcing_amplitude(1.0) == 0:
        raise ValueError(f"{oscillator.told('force', 'unbalance')}: a quiet motion needs a forcing")
    frequency = check_number(
        "frequency",
        frequency,
        above=oscillator.linear_frequency,
        why="below the linear frequency a small motion follows its forcing",
    )
    return Flight(
        damper.mass_ratio,
        damper.restitution,
        frequency / damper.contact_frequency,
        oscillator.damping / frequency,
        oscillator.linear_frequency / frequency,
    )


@cache
def least_displacement_ratio(flight) -> float:
    """Return rm W^2 d0/f (f: forcing amplitude) for the clearance with the smallest max |Z1|."""
    impulses = np.linspace(0, flight.largest_impulse, GRID + 2)[1:-1]
    best = int(np.argmin(flight.largest_displacement(impulses)))
    bounds = impulses[max(best - 1, 0)], impulses[min(best + 1, GRID - 1)]
    minimum = minimize_scalar(
        flight.largest_displacement, bounds=bounds, method="bounded", options={"xatol": 1e-10}
    )
    return float(flight.ratio(minimum.x))
