"""The exact orbit next to an approximate state: Newton's method on the event-driven flow."""

from typing import NamedTuple

import numpy as np

from impact_damper.kernel import advance, side_of, workspace
from impact_damper.orbits import strobe_time

TOLERANCE = 1e-14
CLOSED = 1e-11
STEPS = 12


class ExactOrbit(NamedTuple):
    """An orbit of one forcing period, or the attempt at one.

    Attributes
    ----------
    state : numpy.ndarray, shape (4,)
        Z1, Z1', Z2, Z2' at W T = pi/2.
    multipliers : numpy.ndarray, shape (2 or 4,)
        All Floquet multipliers over the forcing period, complex; two without contacts.
    residual : float
        Largest component of the state's distance from its return.
    contact_time : float
        Time in contact over the period.
    """

    state: np.ndarray
    multipliers: np.ndarray
    residual: float
    contact_time: float

    @property
    def found(self) -> bool:
        """Whether the state returns."""
        return self.residual <= CLOSED


def exact_orbit(p, state) -> ExactOrbit:
    """Orbit of one forcing period near a state at W T = pi/2, which lies in mid-flight.

    Parameters
    ----------
    p : array, shape (7,)
        Packed parameters.
    state : array, shape (4,)
    """
    best = None
    for _ in range(STEPS):
        end, derivative, contacts, contact_time = _period(p, state)
        active = 4 if contacts else 2
        derivative = derivative[:active, :active]
        change = (state - end)[:active]
        size = float(np.max(np.abs(change)))
        if best is not None and not size < best.residual:
            break
        best = ExactOrbit(state, np.linalg.eigvals(derivative) + 0j, size, contact_time)
        step = np.linalg.solve(derivative - np.eye(active), change)
        # without contacts the loose mass keeps its place
        state = state + (step if active == 4 else np.tile(step, 2))
    return best


def _period(p, state):
    """State, derivative, contacts and time in contact after a forcing period."""
    end, tangents, begin = state.copy(), np.eye(4), strobe_time(p)
    _, contacts, touching = advance(
        p, end, tangents, side_of(p, end), begin, 5 * begin, TOLERANCE, workspace()
    )
    return end, tangents.T, contacts, touching
