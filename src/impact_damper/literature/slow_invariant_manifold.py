"""The vibro-impact absorber of small mass: its slow invariant manifold, thresholds and ring-down.

After Gendelman, "Analytic treatment of a system with a vibro-impact nonlinear energy sink", J.
Sound Vib. 331(21), 4599-4608, 2012, and Gourc, Michon, Seguy and Berlioz, "Targeted energy transfer
under harmonic forcing with a vibro-impact nonlinear energy sink: analytical and experimental
developments", J. Vib. Acoust. 137(3), 031008, 2015.
The primary mass has a linear spring, and all results hold to the first order in the mass ratio rm
and in the damping ratio z. Lengths are divided by half the gap d0, forces by the spring's force at
the displacement d0, frequencies W by the natural frequency, and the unit of time is 1/(natural
frequency).

The primary mass moves as a sine of amplitude x; the loose mass, of speed w, flies from wall to wall
in half a period. Let t = pi w/(2 W d0), the speed of the loose mass as a ratio. Flight and
restitution e relate x to t: the relation is the slow invariant manifold, along which motions change
slowly,

    x^2 = (t - 1)^2 + (q t)^2,      q = (2/pi) (1 - e)/(1 + e),

since at an impact the primary mass has the displacement t - 1 and the velocity -q t W. The
derivative of the map from impact to impact has the determinant e^2 and the trace
2 e - (1 + e)^2 (pi^2/4) (t - 1)/t, so the manifold is stable for 1/(1 + q^2) < t < pi^2/(pi^2 - 4).
The impulses on the primary mass have the first harmonic (8 rm/pi^2) W^2 t, in phase with the
impacts. The balance of first harmonics gives the force F that a motion needs at W; for given t this
force is least if it is in phase with the velocity of the primary mass,

    W^2 = x^2/(x^2 + c t (t - 1)),    F = 2 z W x + c W^2 q t^2/x,    c = 8 rm/pi^2.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.system.bounds import (
    MASS_RATIO_RANGE,
    RESTITUTION_RANGE,
    check_number,
)

# Number of ratios t at which the force is computed before its extremes are refined.
SAMPLES = 201


class Threshold(NamedTuple):
    """An extreme of the force along the stable part of the manifold.

    Attributes
    ----------
    force : float
        F divided by the spring's force at half the gap.
    ratio : float
        t, the speed of the loose mass as a ratio.
    frequency : float
        W divided by the natural frequency.
    amplitude : float
        x, the amplitude of the primary mass divided by half the gap.
    """

    force: float
    ratio: float
    frequency: float
    amplitude: float


class Optimum(NamedTuple):
    """The clearance for which the response at the natural frequency is least.

    Attributes
    ----------
    clearance : float
        Half the gap divided by the static deflection F/k.
    amplitude : float
        Amplitude of the primary mass divided by the static deflection.
    """

    clearance: float
    amplitude: float


class VibroImpactAbsorber:
    """A loose mass of small mass ratio in a linear oscillator.

    Parameters
    ----------
    mass_ratio : float
        rm.
    restitution : float
        e < 1: without losses the manifold is not stable.
    damping_ratio : float
        z of the oscillator.

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or out of range.
    """

    def __init__(self, mass_ratio, restitution, damping_ratio=0.0):
        self.mass_ratio = check_number("mass_ratio", mass_ratio, **MASS_RATIO_RANGE)
        self.restitution = check_number("restitution", restitution, **RESTITUTION_RANGE)
        self.damping_ratio = check_number("damping_ratio", damping_ratio, least=0.0, most=1.0)
        self._loss = 2 / np.pi * (1 - restitution) / (1 + restitution)
        self._coupling = 8 * mass_ratio / np.pi**2

    @property
    def stable_ratios(self) -> tuple[float, float]:
        """Ratios t at the ends of the stable part of the manifold: a fold, a loss of symmetry."""
        return 1 / (1 + self._loss**2), np.pi**2 / (np.pi**2 - 4)

    def amplitude(self, ratio):
        """Return the amplitude x of the primary mass on the manifold for ratios t."""
        return np.hypot(np.asarray(ratio) - 1, self._loss * np.asarray(ratio))

    def frequency(self, ratio):
        """Return the frequency W at which the force needed for ratios t is least."""
        size, ratio = self.amplitude(ratio), np.asarray(ratio)
        return size / np.sqrt(size**2 + self._coupling * ratio * (ratio - 1))

    def force(self, ratio):
        """Return this least force F, divided by the spring's force at half the gap."""
        size, turning = self.amplitude(ratio), self.frequency(ratio)
        absorbed = self._coupling * turning**2 * self._loss * np.asarray(ratio) ** 2 / size
        return 2 * self.damping_ratio * turning * size + absorbed

    def activation(self) -> Threshold:
        """Return the least force on the stable part: a smaller one does not drive the absorber."""
        return self._extreme(1)

    def upper_threshold(self) -> Threshold:
        """Return the largest force on the stable part: a larger one overcomes the absorber."""
        return self._extreme(-1)

    def _extreme(self, sign):
        ratios = np.linspace(*self.stable_ratios, SAMPLES)
        forces = sign * self.force(ratios)
        k = int(np.argmin(forces))
        ratio = ratios[k]
        if 0 < k < SAMPLES - 1:
            bounds = ratios[k - 1], ratios[k + 1]
            ratio = minimize_scalar(
                lambda t: sign * self.force(t), bounds=bounds, method="bounded"
            ).x
        values = (float(f(ratio)) for f in (self.force, self.frequency, self.amplitude))
        force, frequency, amplitude = values
        return Threshold(force, float(ratio), frequency, amplitude)

    def optimum(self) -> Optimum:
        """Return the clearance of the least response at the natural frequency.

        By the balance, F/x = 2 z W + c W^2 q t^2/x^2, so x/F is least where t/x is largest. On the
        manifold this is at t = 1, where W = 1 and x = q: impacts take place in the middle position.
        """
        clearance = 1 / (2 * self.damping_ratio * self._loss + self._coupling)
        return Optimum(clearance, self._loss * clearance)

    def ring_down_time(self, first, last):
        """Return the time in which the ratio t falls in a free decay without damping.

        Two impacts a period lose the energy (2/pi) rm (1 - e)/(1 + e) w^2 per unit of time. The
        energy x^2/2 of the primary mass falls by this; integration over t gives

            (8 rm/pi^3) (1 - e)/(1 + e) time = (1 + q^2) ln(first/last) + 1/first - 1/last.

        Parameters
        ----------
        first, last : float
            Ratios t at the beginning and at the end, first > last.
        """
        rate = 4 * self.mass_ratio * self._loss / np.pi**2
        path = (1 + self._loss**2) * np.log(first / last) + 1 / first - 1 / last
        return path / rate
