"""Locate bifurcations (zeros of test functions) and changes of contact on a step of a branch."""

from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.model.packed import FREQUENCY
from impact_damper.orbits.continuation import Point, point_at_distance

# A place is a distance along the branch from the beginning of the step.
# FINE: largest tolerance of the place of a bifurcation, divided by the length of the step.
# PLACE: tolerance of the place of a change of contact; relative for steps longer than 1.
FINE = 1e-3
PLACE = 1e-12
# A multiplier is complex if its imaginary part exceeds COMPLEX.
COMPLEX = 1e-6
# If the modulus of a multiplier exceeds 1 + NEAR_CIRCLE at a bifurcation, the orbits on both sides
# are unstable.
NEAR_CIRCLE = 1e-3
# A flight between two contacts is about to vanish if it is shorter than MERGED forcing cycles.
MERGED = 1e-3
# Largest number of changes of contact that are located on one step.
MOST_CHANGES = 8
# Indices i, j of all pairs i < j of 2 or 4 multipliers, keyed by the number of multipliers.
PAIRS = {count: np.triu_indices(count, 1) for count in (2, 4)}


class Event(NamedTuple):
    """An event of a branch, with the walls touched (`Orbit.sequence`) before and after it.

    At a grazing a contact appears or vanishes in flight; at a merging two contacts with one wall
    become one. The other kinds are those of TESTS.
    """

    kind: str
    point: Point
    before: str
    after: str


def _fold(point):
    """Return the component of the tangent along the parameter, which is zero at a fold."""
    return point.tangent[-1]


def _reversal(point, symmetric):
    """Return the product of mu + 1 over the multipliers mu of a cycle, or 1 for other orbits.

    A multiplier is -1 where a `symmetric` orbit, whose cycle is half its period, loses its
    symmetry, and where another orbit doubles its period.
    """
    orbit = point.orbit
    return _product(orbit.cycle_multipliers + 1) if (orbit.sign < 0) == symmetric else 1.0


def _pairs(point):
    """Return the product of mu_i mu_j - 1 over all pairs: 0 if a conjugate pair has modulus 1."""
    values = point.orbit.multipliers[: point.orbit.active]
    first, second = PAIRS[len(values)]
    return _product(values[first] * values[second] - 1)


def _product(values):
    """Return a number with the sign of a product of complex numbers, and no overflow."""
    return float((values / np.maximum(1, np.abs(values))).prod().real)


# For each kind of bifurcation the test function of a point, which is zero at the bifurcation, and
# the tolerance of the place of the zero. At a fold the parameter changes with the square of the
# distance, and Newton's method is nearly singular.
TESTS = {
    "fold": (_fold, 1e-7),
    "symmetry_breaking": (partial(_reversal, symmetric=True), 1e-11),
    "period_doubling": (partial(_reversal, symmetric=False), 1e-11),
    "neimark_sacker": (_pairs, 1e-11),
}


def bifurcations_between(point_at, start, end, first, last):
    """Locate all bifurcations between two points of a branch."""
    located, lost = [], 0
    for kind, (test, precision) in TESTS.items():
        if test(start) * test(end) >= 0:
            continue
        try:
            tolerance = min(precision, FINE * abs(last - first))
            known = {first: start, last: end}

            def value(place, test=test, known=known):
                if place not in known:
                    known[place] = point_at(place)
                return test(known[place])

            place = brentq(value, first, last, xtol=tolerance)
            point = known[place]
            if not point.orbit.stable and abs(point.orbit.multipliers[0]) < 1 + NEAR_CIRCLE:
                # The point is moved to the stable side of the bifurcation, if one side is stable.
                sides = (place - 2 * tolerance, place + 2 * tolerance)
                beside = [point_at(side) for side in sides if (side - first) * (side - last) < 0]
                point = next((each for each in beside if each.orbit.stable), point)
        except (ArithmeticError, ValueError):
            lost += 1
            continue
        if kind != "neimark_sacker" or _is_complex_pair(point.orbit.multipliers):
            sequence = point.orbit.sequence
            located.append((place, Event(kind, point, sequence, sequence)))
    return sorted(located, key=lambda pair: abs(pair[0] - first)), lost


def events_between(start, end, length):
    """Locate all events on a step, at most MOST_CHANGES of them changes of contact."""

    known = {0.0: start, length: end}

    def point_at(distance):
        if distance not in known:
            low = max(place for place in known if place < distance)
            high = min(place for place in known if place > distance)
            found = point_at_distance(start, known[low], known[high], distance)
            if found is None:
                raise ArithmeticError
            known[distance] = found
        return known[distance]

    located, lost = bifurcations_between(point_at, start, end, 0, length)
    try:
        located += _changes_of_contact(point_at, start, end, length)
    except ArithmeticError:
        lost += 1
    return [event for _, event in sorted(located, key=lambda pair: pair[0])], lost


def _is_complex_pair(multipliers):
    """Return whether the two multipliers whose product is nearest to 1 are a conjugate pair."""
    values = multipliers[np.isfinite(multipliers)]
    first, second = PAIRS[len(values)]
    k = np.argmin(np.abs(values[first] * values[second] - 1))
    one, other = values[first[k]], values[second[k]]
    return abs(one.imag) > COMPLEX and np.isclose(one, other.conjugate())


def _changes_of_contact(point_at, start, end, length):
    """Return distance and event of each change of the sequence of walls, found by bisection."""
    located, inner, before = [], 0.0, start.orbit.sequence
    while before != end.orbit.sequence and len(located) < MOST_CHANGES:
        outer, after = length, end.orbit
        while outer - inner > PLACE * max(1.0, length):
            middle = (inner + outer) / 2
            if middle in (inner, outer):
                break
            orbit = point_at(middle).orbit
            if orbit.sequence == before:
                inner = middle
            else:
                outer, after = middle, orbit
        # The event is stored with the orbit of the side on which the contact exists.
        sides = point_at(inner), point_at(outer)
        point = max(sides, key=lambda side: len(side.orbit.sequence))
        kind = _contact_event(point.orbit)
        located.append((outer, Event(kind, point, before, after.sequence)))
        inner, before = outer, after.sequence
    return located


def _contact_event(orbit):
    """Return the kind of event at which the slowest contact of an orbit appeared.

    It is a merging if a very short flight follows another contact with the same wall.
    """
    contacts = orbit.contacts
    k = int(np.argmin(np.abs(contacts[:, 3])))
    period = 2 * np.pi / orbit.p[FREQUENCY]
    flight = (contacts[k, 1] - contacts[k - 1, 2]) % (orbit.periods * period)
    merging = contacts[k, 0] == contacts[k - 1, 0] and flight < MERGED * period
    return "merging" if merging else "grazing"
