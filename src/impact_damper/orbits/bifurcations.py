"""Locate the events on a step of a branch: bifurcations, and changes in the order of contacts."""

from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.model.packed import FREQUENCY
from impact_damper.orbits.continuation import Point, point_at_distance

# The place of a bifurcation on a step is found to within FINE times the length of the step.
FINE = 1e-3
# The place at which the order of contacts changes has an error below PLACE x max(1, step length).
PLACE = 1e-12
# A multiplier counts as complex if its imaginary part exceeds COMPLEX in modulus.
COMPLEX = 1e-6
# An unstable orbit counts as nearly stable if all multipliers have moduli below 1 + NEAR_CIRCLE.
NEAR_CIRCLE = 1e-3
# Two contacts with one wall count as merging if the flight between them is below MERGED cycles.
MERGED = 1e-3
# At most this number of changes in the order of contacts are located on one step.
MOST_CHANGES = 8
# Index arrays that select all pairs of multipliers, for 2 and for 4 multipliers.
PAIRS = {count: np.triu_indices(count, 1) for count in (2, 4)}


class Event(NamedTuple):
    """A bifurcation of a branch, or a change in the order of contacts along a branch.

    kind: "fold", "symmetry_breaking", "period_doubling", "neimark_sacker", "grazing" (a contact
    appears or vanishes in flight) or "merging" (two contacts become one, or the reverse).
    point: The point of the branch at the event, or close beside the event.
    before, after: Order of contacts (`Orbit.sequence`) before and after the event.
    """

    kind: str
    point: Point
    before: str
    after: str


def _reversal(point, symmetric):
    """Return a number that is zero where one of `Orbit.cycle_multipliers` is -1.

    There a symmetric orbit loses its symmetry, and an asymmetric orbit doubles its period.
    `symmetric` selects one of these two sorts of orbits. An orbit of the other sort gives 1.
    """
    orbit = point.orbit
    return _product(orbit.cycle_multipliers + 1) if (orbit.sign < 0) == symmetric else 1.0


def _pairs(point):
    """Return a number that is zero if the orbit has two multipliers whose product is 1."""
    values = point.orbit.multipliers[: point.orbit.active]
    first, second = PAIRS[len(values)]
    return _product(values[first] * values[second] - 1)


def _product(values):
    return float((values / np.maximum(1, np.abs(values))).prod().real)


# For each kind of bifurcation: a function of a point of a branch, which is zero at the bifurcation,
# and the error allowed in the place of the bifurcation (see `bifurcations_between`).
TESTS = {
    "fold": (lambda point: point.tangent[-1], 1e-7),
    "symmetry_breaking": (partial(_reversal, symmetric=True), 1e-11),
    "period_doubling": (partial(_reversal, symmetric=False), 1e-11),
    "neimark_sacker": (_pairs, 1e-11),
}


def bifurcations_between(point_at, start, end, first, last):
    """Return (place, `Event`) for each bifurcation between two points of a branch.

    Also return the number of bifurcations that were not located. `start` and `end` are the points
    at the places `first` and `last`. `point_at(place)` finds points between them. A place is a
    distance along the branch or, near a grazing, the value of |Z2| - d0 in an extremum of Z2.
    """
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
                # If an orbit close beside the bifurcation is stable, store the point of this orbit.
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
    """Return the events on a step of `length`, and the number of events that were not located."""
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
    values = multipliers[np.isfinite(multipliers)]
    first, second = PAIRS[len(values)]
    k = np.argmin(np.abs(values[first] * values[second] - 1))
    one, other = values[first[k]], values[second[k]]
    return abs(one.imag) > COMPLEX and np.isclose(one, other.conjugate())


def _changes_of_contact(point_at, start, end, length):
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
        # Of the two points beside the event, store the one whose orbit has more contacts.
        sides = point_at(inner), point_at(outer)
        point = max(sides, key=lambda side: len(side.orbit.sequence))
        kind = _contact_event(point.orbit)
        located.append((outer, Event(kind, point, before, after.sequence)))
        inner, before = outer, after.sequence
    return located


def _contact_event(orbit):
    contacts = orbit.contacts
    k = int(np.argmin(np.abs(contacts[:, 3])))
    period = 2 * np.pi / orbit.p[FREQUENCY]
    flight = (contacts[k, 1] - contacts[k - 1, 2]) % (orbit.periods * period)
    merging = contacts[k, 0] == contacts[k - 1, 0] and flight < MERGED * period
    return "merging" if merging else "grazing"
