"""What happens to an orbit between two points of a branch, located.

An event is a zero of a function of the point, found along the step between two points, or for
a change of contacts the place where the sequence of walls changes.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.orbits.continuation import Point
from impact_damper.system.packed import FREQUENCY

PLACE = 1e-12
COMPLEX = 1e-6
MERGED = 1e-3  # a flight shorter than this part of the forcing period has all but vanished
SIMILAR = 1e-4


class Event(NamedTuple):
    """An event of a branch.

    Attributes
    ----------
    kind : str
        One of fold, symmetry_breaking, period_doubling, neimark_sacker, grazing, merging.
    point : Point
        Where it happens.
    before, after : str
        Walls touched, as `Orbit.sequence`, on both sides.
    """

    kind: str
    point: Point
    before: str
    after: str


def _fold(point):
    return point.tangent[-1]


def _symmetry(point):
    root = point.orbit.root
    n = point.orbit.active
    return 1.0 if root is None else np.linalg.det(root[:n, :n] + np.eye(n))


def _doubling(point):
    orbit = point.orbit
    n = orbit.active
    return 1.0 if orbit.root is not None else np.linalg.det(orbit.monodromy[:n, :n] + np.eye(n))


def _pairs(point):
    """Product of mu_i mu_j - 1 over all pairs; it vanishes where a pair lies on the unit circle."""
    values = point.orbit.multipliers[: point.orbit.active]
    first, second = np.triu_indices(len(values), 1)
    return float(np.prod(values[first] * values[second] - 1).real)


# Function of a point that vanishes at an event, and how closely its place along the branch is
# sought: of a fold the parameter is sharper by far, and where branches meet Newton's method is
# at its end closer by. Only an orbit that is not symmetric can double its period.
TESTS = {
    "fold": (_fold, 1e-7),
    "symmetry_breaking": (_symmetry, 1e-12),
    "period_doubling": (_doubling, 1e-12),
    "neimark_sacker": (_pairs, 1e-12),
}


def events_between(problem, start, end, length):
    """Events on the step of a length from one point to another, in order, and how many are lost.

    A zero that Newton's method cannot be led to, or one of the product of pairs that belongs to
    two real multipliers, is no event; the former counts as lost.
    """
    found, lost = [], 0

    def at(distance):
        point = problem.step(start, distance)
        if point is None:
            raise ArithmeticError
        return point

    for kind, (test, precision) in TESTS.items():
        if test(start) * test(end) >= 0:
            continue
        try:
            place = brentq(
                lambda distance, test=test: test(at(distance)), 0, length, xtol=precision
            )
            point = at(place)
        except (ArithmeticError, ValueError):
            lost += 1
            continue
        if kind != "neimark_sacker" or _is_complex_pair(point.orbit.multipliers):
            sequence = point.orbit.sequence
            found.append((place, Event(kind, point, sequence, sequence)))
    try:
        found += _changes_of_contact(at, start, end, length)
    except ArithmeticError:
        lost += 1
    return [event for _, event in sorted(found, key=lambda pair: pair[0])], lost


def _is_complex_pair(multipliers):
    """Whether the multipliers nearest to the unit circle are a complex pair."""
    values = multipliers[np.isfinite(multipliers)]
    nearest = values[np.argmin(np.abs(np.abs(values) - 1))]
    return abs(nearest.imag) > COMPLEX


def _changes_of_contact(at, start, end, length):
    """Changes of the sequence of contacts on a step, each between the last place and the next."""
    found, inner, before = [], 0.0, start.orbit.sequence
    while before != end.orbit.sequence and len(found) < 8:
        outer, after = length, end.orbit
        while outer - inner > PLACE * max(1.0, length):
            middle = (inner + outer) / 2
            if middle in (inner, outer):
                break
            orbit = at(middle).orbit
            if orbit.sequence == before:
                inner = middle
            else:
                outer, after = middle, orbit
        # of the two sides the one on which the contact exists
        point = max(at(inner), at(outer), key=lambda side: len(side.orbit.sequence))
        kind = _contact_event(point.orbit)
        found.append((outer, Event(kind, point, before, after.sequence)))
        inner, before = outer, after.sequence
    return found


def _contact_event(orbit):
    """Whether the weakest contact has just parted from another or was born in flight."""
    contacts = orbit.contacts
    k = int(np.argmin(np.abs(contacts[:, 3])))
    period = 2 * np.pi / orbit.p[FREQUENCY]
    flight = (contacts[k, 1] - contacts[k - 1, 2]) % (orbit.periods * period)
    merging = contacts[k, 0] == contacts[k - 1, 0] and flight < MERGED * period
    return "merging" if merging else "grazing"
