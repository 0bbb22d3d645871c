"""The vibro-impact absorber of small mass: its slow invariant manifold, thresholds and ring-down.

After Gendelman, "Analytic treatment of a system with a vibro-impact nonlinear energy sink", J.
Sound Vib. 331(21), 4599-4608, 2012, and Gourc, Michon, Seguy and Berlioz, "Targeted energy transfer
under harmonic forcing with a vibro-impact nonlinear energy sink: analytical and experimental
developments", J. Vib. Acoust. 137(3), 031008, 2015.
The primary mass has a linear spring, and all results hold to the first order in the mass ratio rm
and in the damping ratio z. Lengths are given over half the gap, forces over the spring's force at
that displacement, and times in 1/natural frequency.

The primary mass moves as a sine of amplitude x, the loose mass flies from wall to wall in half a
period. With the speed of the loose mass as ratio t = pi w/(2 W d0), flight and restitution give the
manifold

    x^2 = (t - 1)^2 + (q t)^2,      q = (2/pi) (1 - e)/(1 + e),

since the displacement at an impact is t - 1 and the velocity -q t W. The derivative of the map from
impact to impact has the determinant e^2 and the trace 2 e - (1 + e)^2 (pi^2/4) (t - 1)/t, so the
manifold is stable for 1/(1 + q^2) < t < pi^2/(pi^2 - 4). The impulses have the first harmonic
(8 rm/pi^2) W^2 t in the phase of the impacts. Its balance with a force F at W determines F; the
force is least where it is in phase with the velocity,

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

# Ratios of speed at which the force is computed before its extremes are refined.
SAMPLES = 201


class Threshold(NamedTuple):
    """An extreme of the force along the stable part of the manifold.

    Attributes
    ----------
    force : float
        F over the spring's force at half the gap.
    ratio : float
        t, speed of the loose mass.
    frequency : float
        W over the natural frequency.
    amplitude : float
        Of the primary mass, over half the gap.
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
        Half the gap, over the static deflection F/k.
    amplitude : float
        Of the primary mass, over the static deflection.
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
        """Return the amplitude of the primary mass on the manifold, over half the gap."""
        return np.hypot(np.asarray(ratio) - 1, self._loss * np.asarray(ratio))

    def frequency(self, ratio):
        """Return the frequency at which the force is in phase with the velocity."""
        size, ratio = self.amplitude(ratio), np.asarray(ratio)
        return size / np.sqrt(size**2 + self._coupling * ratio * (ratio - 1))

    def force(self, ratio):
        """Return the force that this motion needs, over the spring's force at half the gap."""
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

        By the balance, F/x = 2 z W + c W^2 q t^2/x^2. On the manifold t/x is largest for t = 1:
        impacts in the middle position, at W = 1, where x = q.
        """
        clearance = 1 / (2 * self.damping_ratio * self._loss + self._coupling)
        return Optimum(clearance, self._loss * clearance)

    def ring_down_time(self, first, last):
        """Return the time in which the ratio t falls in a free decay without damping.

        The energy lost in two impacts a period, (2/pi) rm (1 - e)/(1 + e) w^2 per unit of time, is
        taken from x^2/2; integrated over t,

            (8 rm/pi^3) (1 - e)/(1 + e) time = (1 + q^2) ln(first/last) + 1/first - 1/last.

        Parameters
        ----------
        first, last : float
            Ratios at beginning and end, first > last.
        """
        rate = 4 * self.mass_ratio * self._loss / np.pi**2
        path = (1 + self._loss**2) * np.log(first / last) + 1 / first - 1 / last
        return path / rate
