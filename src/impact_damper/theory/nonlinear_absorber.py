"""The nonlinear tuned vibration absorber on an undamped oscillator with a cubic spring.

The source is Habib, Detroux, Viguie and Kerschen, "Nonlinear generalization of Den Hartog's
equal-peak method", Mech. Syst. Signal Process. 52-53, 17-28, 2015, doi 10.1016/j.ymssp.2014.08.009.
All quantities are dimensionless. m is the mass ratio, f the tuning (the natural frequency of the
absorber divided by the natural frequency of the oscillator), z the damping ratio of the absorber,
and u = x1 - x2 the displacement of the oscillator relative to the absorber. N is the force between
the two:

    x1'' + x1 + k x1^3 + N = F cos(r T),    m (x1 - u)'' = N,
    N = m (f^2 u + 2 z f u') + k2 u^3.

`tuned_mass_damper.exact_optimum` gives f and z. With k2 = 2 m^2 k/(1 + 4 m) the two peaks of
the response stay equal to first order in k F^2.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.theory.tuned_mass_damper import exact_optimum

# HARMONICS    odd harmonics of the balance
# SAMPLES      number of samples of a period in the balance
# FINE         number of samples of a period, whose maximum is the largest displacement
# FREQUENCIES  grid on which peaks are found before they are refined
HARMONICS = np.array([1, 3, 5, 7])
SAMPLES, FINE = 64, 2048
FREQUENCIES = np.linspace(0.75, 1.4, 131)
# Newton's method:
# CONVERGED   largest relative size of the last correction
# ITERATIONS  largest number of corrections
CONVERGED = 1e-12
ITERATIONS = 30


class Peaks(NamedTuple):
    """Maxima of the response over the frequency, by ascending frequency.

    Attributes
    ----------
    frequencies : numpy.ndarray, shape (count,)
    displacements : numpy.ndarray, shape (count,)
        Largest |x1| divided by the static deflection F.
    """

    frequencies: np.ndarray
    displacements: np.ndarray


def tuned_cubic(mass_ratio, cubic) -> float:
    """Return the cubic coefficient k2 of the absorber for the coefficient k of the oscillator."""
    return 2 * mass_ratio**2 * cubic / (1 + 4 * mass_ratio)


class AbsorberOnDuffing:
    """Periodic motions of the oscillator with the absorber, by harmonic balance with HARMONICS.

    Parameters
    ----------
    mass_ratio, cubic, absorber_cubic : float
        m, k and k2.
    force : float
        F.
    """

    def __init__(self, mass_ratio, cubic, absorber_cubic, force):
        self.mass, self.cubic, self.absorber_cubic = mass_ratio, cubic, absorber_cubic
        self.force = force
        _, tuned, damping = exact_optimum(mass_ratio)
        self._stiffness, self._dashpot = mass_ratio * tuned**2, 2 * mass_ratio * damping * tuned
        # Matrices that map coefficients (of all cosines, then of all sines) to samples of a period,
        # and the matrix that maps SAMPLES samples back to coefficients.
        self._sample, self._fine = _samples(SAMPLES), _samples(FINE)
        self._project = self._sample.T * 2 / SAMPLES
        turn = np.diag(HARMONICS.astype(float))
        self._rate = np.block([[0 * turn, turn], [-turn, 0 * turn]])
        self._forcing = np.eye(2 * len(HARMONICS))[0] * force

    def balance(self, frequency, guess=None):
        """Return the coefficients of x1 and u, shape (2, 2 * len(HARMONICS)), at a frequency.

        Newton's method begins at `guess`, or at zero without a guess.

        Raises
        ------
        ArithmeticError
            If Newton's method does not converge.
        """
        count = 2 * len(HARMONICS)
        unknowns = np.zeros(2 * count) if guess is None else guess.ravel().copy()
        for _ in range(ITERATIONS):
            residual, slope = self._residual(frequency, unknowns.reshape(2, count))
            change = np.linalg.solve(slope, residual)
            unknowns -= change
            if np.max(np.abs(change)) < CONVERGED * np.max(np.abs(unknowns)):
                return unknowns.reshape(2, count)
        raise ArithmeticError(f"harmonic balance at frequency {frequency:g}: no convergence")

    def displacement(self, coefficients):
        """Return the largest |x1| of a solution divided by the static deflection F."""
        return np.max(np.abs(self._fine @ coefficients[0])) / self.force

    def peaks(self) -> Peaks:
        """Return the maxima of the response that is followed from FREQUENCIES[0] upward.

        Raises
        ------
        ArithmeticError
            If Newton's method does not converge.
        """
        solutions = [None]
        for frequency in FREQUENCIES:
            solutions.append(self.balance(frequency, solutions[-1]))
        solutions = solutions[1:]
        sizes = np.array([self.displacement(each) for each in solutions])
        places = 1 + np.flatnonzero((sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:]))
        maxima = [
            minimize_scalar(
                lambda r, k=k: -self.displacement(self.balance(r, solutions[k])),
                bounds=(FREQUENCIES[k - 1], FREQUENCIES[k + 1]),
                method="bounded",
                options={"xatol": 1e-9},
            )
            for k in places
        ]
        frequencies, negative = np.array([(each.x, each.fun) for each in maxima]).reshape(-1, 2).T
        return Peaks(frequencies, -negative)

    def _residual(self, frequency, coefficients):
        """Return the residual of the balance and its derivative."""
        first, relative = coefficients
        rate, unit = frequency * self._rate, np.eye(len(first))
        inertia = rate @ rate
        link = self._stiffness * unit + self._dashpot * rate
        spring, spring_slope = self._cube(self.cubic, first)
        absorber, absorber_slope = self._cube(self.absorber_cubic, relative)
        link_force, link_slope = link @ relative + absorber, link + absorber_slope
        residual = np.concatenate(
            [
                inertia @ first + first + spring + link_force - self._forcing,
                self.mass * inertia @ (first - relative) - link_force,
            ]
        )
        slope = np.block(
            [
                [inertia + unit + spring_slope, link_slope],
                [self.mass * inertia, -self.mass * inertia - link_slope],
            ]
        )
        return residual, slope

    def _cube(self, factor, coefficients):
        """Return the coefficients of factor x^3, and their derivative by the coefficients of x."""
        x = self._sample @ coefficients
        slope = self._project @ (3 * factor * x[:, None] ** 2 * self._sample)
        return self._project @ (factor * x**3), slope


def _samples(count):
    """Return the matrix that maps coefficients to `count` samples of a period."""
    angles = np.outer(np.arange(count) * 2 * np.pi / count, HARMONICS)
    return np.hstack([np.cos(angles), np.sin(angles)])
