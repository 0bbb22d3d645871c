"""The vibro-impact absorber of small mass: its slow invariant manifold, thresholds and ring-down.

The theory is from Gendelman, "Analytic treatment of a system with a vibro-impact nonlinear energy
sink", J. Sound Vib. 331(21), 4599-4608, 2012, and from Gourc, Michon, Seguy and Berlioz, "Targeted
energy transfer under harmonic forcing with a vibro-impact nonlinear energy sink: analytical and
experimental developments", J. Vib. Acoust. 137(3), 031008, 2015. The primary mass has a linear
spring. All results hold to first order in the mass ratio rm and in the damping ratio z. Lengths are
divided by the clearance d0, forces by the spring's force at the displacement d0, and frequencies by
the natural frequency. The unit of time is 1/(natural frequency).

The primary mass moves as a sine of amplitude x and frequency W. The loose mass flies from wall to
wall with speed w in half a period. Its speed is stated as the dimensionless ratio
t = pi w/(2 W d0). At an impact the primary mass has the displacement t - 1, which follows from the
flight, and the velocity -q t W, which follows from the restitution e. The resulting relation
between x and t is the slow invariant manifold, along which motions change slowly:

    x^2 = (t - 1)^2 + (q t)^2,      q = (2/pi) (1 - e)/(1 + e).

The derivative of the map from impact to impact has the determinant e^2 and the trace
2 e - (1 + e)^2 (pi^2/4) (t - 1)/t. The manifold is therefore stable for
1/(1 + q^2) < t < pi^2/(pi^2 - 4). The impulses on the primary mass have the first harmonic
(8 rm/pi^2) W^2 t, in phase with the impacts. The balance of first harmonics gives the force F that
drives a motion with ratio t at frequency W. For given t the smallest force is in phase with the
velocity of the primary mass; then

    W^2 = x^2/(x^2 + c t (t - 1)),    F = 2 z W x + c W^2 q t^2/x,    c = 8 rm/pi^2.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.model.bounds import MASS_RATIO_RANGE, RESTITUTION_RANGE, check_number

# Number of ratios t at which the force is computed before its extreme values are refined.
SAMPLES = 201


class Threshold(NamedTuple):
    """An extreme value of the force along the stable part of the manifold.

    Attributes
    ----------
    force : float
        F divided by the spring's force at the displacement d0.
    ratio : float
        t = pi w/(2 W d0), with the speed w of the loose mass.
    frequency : float
        W divided by the natural frequency.
    amplitude : float
        x, the amplitude of the primary mass divided by d0.
    """

    force: float
    ratio: float
    frequency: float
    amplitude: float


class Optimum(NamedTuple):
    """The clearance for which the response at the natural frequency is smallest.

    Attributes
    ----------
    clearance : float
        d0 divided by the static deflection F/k, with the stiffness k of the spring.
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
        e < 1. With e = 1 the manifold is not stable.
    damping_ratio : float
        Damping ratio z of the oscillator.

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
        """Ratios t at the ends of the stable part of the manifold: fold and loss of symmetry."""
        return 1 / (1 + self._loss**2), np.pi**2 / (np.pi**2 - 4)

    def amplitude(self, ratio):
        """Return the amplitude x of the primary mass on the manifold for ratios t."""
        return np.hypot(np.asarray(ratio) - 1, self._loss * np.asarray(ratio))

    def frequency(self, ratio):
        """Return the frequency W at which the force that drives ratios t is smallest."""
        size, ratio = self.amplitude(ratio), np.asarray(ratio)
        return size / np.sqrt(size**2 + self._coupling * ratio * (ratio - 1))

    def force(self, ratio):
        """Return the smallest force F that drives ratios t; its frequency is `frequency(ratio)`."""
        size, turning = self.amplitude(ratio), self.frequency(ratio)
        absorbed = self._coupling * turning**2 * self._loss * np.asarray(ratio) ** 2 / size
        return 2 * self.damping_ratio * turning * size + absorbed

    def activation(self) -> Threshold:
        """Return the smallest force on the stable part; smaller forces sustain no impacts."""
        return self._extreme(1)

    def upper_threshold(self) -> Threshold:
        """Return the largest force on the stable part. Larger forces overcome the absorber."""
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
        """Return the clearance of the smallest response at the natural frequency.

        By the balance of first harmonics F/x = 2 z W + c W^2 q t^2/x^2, so x/F is smallest where
        t/x is largest. On the manifold this is at t = 1, where W = 1 and x = q. The primary mass is
        then in its middle position at the impacts.
        """
        clearance = 1 / (2 * self.damping_ratio * self._loss + self._coupling)
        return Optimum(clearance, self._loss * clearance)

    def ring_down_time(self, first, last):
        """Return the time in which the ratio t falls during an unforced decay without damping.

        Two impacts in a period dissipate the energy (2/pi) rm (1 - e)/(1 + e) w^2 per unit of time,
        which the primary mass loses from its energy x^2/2. Integration over t gives

            (8 rm/pi^3) (1 - e)/(1 + e) time = (1 + q^2) ln(first/last) + 1/first - 1/last.

        Parameters
        ----------
        first, last : float
            Ratios t at the beginning and at the end, first > last.
        """
        rate = 4 * self.mass_ratio * self._loss / np.pi**2
        path = (1 + self._loss**2) * np.log(first / last) + 1 / first - 1 / last
        return path / rate
