"""Exact derivatives of a periodic orbit by its parameters: state, largest |Z1|, stability.

An orbit solves y = R(y, p) with its state y and the parameters p. R is the map over its period or,
for a symmetric orbit, the map over half the period followed by a change of sign. With R_y and R_p,
the derivatives of R by y and p, the derivative of the state is therefore
y_p = (1 - R_y)^-1 R_p. The derivative of max |Z1| is the derivative of |Z1| at the phase of the
maximum, because Z1' is zero there. Multipliers are the eigenvalues of R_y. The derivative of a
simple multiplier with the right and left eigenvectors r and l is l (dR_y/dp) r / (l r), where
dR_y/dp is the total derivative, which includes the change of y (`variations`). No difference
quotients are used.

Z1 is the displacement of the primary mass.
"""

from dataclasses import dataclass

import numpy as np

from impact_damper.model.packed import COUNT, DESIGN, FREQUENCY, design_slopes
from impact_damper.orbits.orbit import TURN, Orbit
from impact_damper.orbits.paths import POINTS, Path, follow_path
from impact_damper.orbits.variations import Variations

# Two extrema of |Z1|, two moduli of multipliers, or two multipliers count as equal if they differ
# relatively by less than EQUAL.
EQUAL = 1e-6


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of an orbit with respect to its packed parameters.

    Attributes
    ----------
    orbit : Orbit
    state_slopes : numpy.ndarray, shape (4, packed.COUNT)
        Derivatives of the state at the phase of the orbit.
    maximum_displacement : float
        max |Z1|.
    displacement_slopes : numpy.ndarray, shape (packed.COUNT,)
        Derivatives of max |Z1|.
    displacement_smooth : bool
        Whether max |Z1| is differentiable. It has a kink if |Z1| is largest at two phases with
        different derivatives.
    modulus : float
        Modulus of the largest Floquet multiplier.
    modulus_slopes : numpy.ndarray, shape (packed.COUNT,)
        Derivatives of the modulus.
    modulus_smooth : bool
        Whether the modulus is differentiable. It has a kink if two multipliers that are not a
        conjugate pair have the largest modulus, or if a real multiplier is double.
    matrix_slopes : numpy.ndarray, shape (packed.COUNT, n, n)
        Total derivatives of R_y, which is the root of the orbit (`Orbit.root`) or, without a root,
        its monodromy matrix. n is `Orbit.active`.
    """

    orbit: Orbit
    state_slopes: np.ndarray
    maximum_displacement: float
    displacement_slopes: np.ndarray
    displacement_smooth: bool
    modulus: float
    modulus_slopes: np.ndarray
    modulus_smooth: bool
    matrix_slopes: np.ndarray

    def by_design(self, slopes) -> dict:
        """Return derivatives with respect to the parameters `packed.DESIGN`, keyed by name.

        Parameters
        ----------
        slopes : array, shape (..., packed.COUNT)
            Derivatives with respect to packed parameters, such as `displacement_slopes`.

        Returns
        -------
        dict
            Each derivative is a number or an array of the shape (...). Without a damper the
            derivatives with respect to the damper's parameters are 0.
        """
        values = np.asarray(slopes) @ design_slopes(self.orbit.p)
        return dict(zip(DESIGN, np.moveaxis(values, -1, 0), strict=True))


def path_of(orbit) -> Path:
    """Return the motion of an orbit over its period, or over half the period if it has a root."""
    begin = orbit.phase / orbit.p[FREQUENCY]
    turns = orbit.periods * (1.0 if orbit.root is None else 0.5)
    return follow_path(orbit.p, orbit.state, begin, begin + turns * TURN / orbit.p[FREQUENCY])


def sensitivity(orbit) -> Sensitivity:
    """Return the derivatives of a converged orbit.

    Raises
    ------
    ValueError
        If the orbit has not converged.
    numpy.linalg.LinAlgError
        If a multiplier is exactly 1, as at a fold, where the derivatives do not exist.
    """
    if not orbit.converged:
        raise ValueError(f"orbit: must have converged, its residual is {orbit.residual:.1e}")
    path, n = path_of(orbit), orbit.active
    variations = Variations(path)
    matrix, sign = (orbit.monodromy, 1) if orbit.root is None else (orbit.root, -1)
    state = np.linalg.solve(np.eye(n) - matrix[:n, :n], sign * variations.slopes()[:n])
    if n == 2:  # the loose mass does not move
        state = np.vstack([state, state])
    along = np.eye(COUNT)
    slopes = sign * variations.matrix_changes(state, along)[:, :n, :n]
    largest, by_parameters, alone = _displacement(path, variations.changes(state, along)[0])
    modulus, relative, simple = _modulus(matrix[:n, :n], slopes)
    power = 1 if orbit.root is None else 2
    return Sensitivity(
        orbit,
        state,
        largest,
        by_parameters,
        alone,
        modulus**power,
        power * modulus**power * relative,
        simple,
        slopes,
    )


def _displacement(path, changes):
    """Return max |Z1| on a path, its derivatives, and whether it is differentiable.

    Parameters
    ----------
    path : Path
    changes : array, shape (n, N)
        Changes of Z1 at the points of the path.
    """
    steps, sizes, weights, _ = path.turns(0)
    at_extrema = changes.reshape(len(changes), -1, POINTS)[:, steps]
    slopes = np.sign(sizes)[:, None] * np.einsum("nek,ek->en", at_extrema, weights)
    first = int(np.argmax(np.abs(sizes)))
    largest = abs(sizes[first])
    equal = np.abs(sizes) > (1 - EQUAL) * largest
    spread = np.max(np.abs(slopes[equal] - slopes[first]))
    smooth = spread <= EQUAL**0.5 * np.max(np.abs(slopes[first]))
    return float(largest), slopes[first], bool(smooth)


def _modulus(matrix, slopes):
    """Return the largest modulus of the eigenvalues of a matrix, and its relative derivatives.

    `slopes` are the derivatives of the matrix. The third result states whether the modulus is
    differentiable.
    """
    values, right = np.linalg.eig(matrix)
    first = int(np.argmax(np.abs(values)))
    value, modulus = values[first], abs(values[first])
    left = np.linalg.inv(right)[first]
    change = np.einsum("i,nij,j->n", left, slopes, right[:, first])
    others = np.delete(values, first)
    if abs(value.imag) > EQUAL * modulus:
        others = others[np.abs(others - value.conjugate()) > EQUAL * modulus]
    smooth = np.all(np.abs(others) < (1 - EQUAL) * modulus)
    return float(modulus), (change / value).real, bool(smooth)
