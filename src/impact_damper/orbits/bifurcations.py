"""Locate the events on a step of a branch: bifurcations, and changes in the order of contacts."""

from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.model.packed import FREQUENCY
from impact_damper.orbits.continuation import Point, point_at_distance

# The place of a bifurcation is found to within FINE times the length of the step, or better.
FINE = 1e-3
# The place of a change of contact is found to within PLACE times max(1, length of the step).
PLACE = 1e-12
# A multiplier counts as complex if its imaginary part exceeds COMPLEX in modulus.
COMPLEX = 1e-6
# An unstable orbit counts as nearly stable if all multipliers have moduli below 1 + NEAR_CIRCLE.
NEAR_CIRCLE = 1e-3
# Two contacts with one wall merge if the flight between them is shorter than MERGED forcing cycles.
MERGED = 1e-3
# Largest number of changes of contact that are located on one step.
MOST_CHANGES = 8
# Index arrays that select all pairs of multipliers, for 2 and for 4 multipliers.
PAIRS = {count: np.triu_indices(count, 1) for count in (2, 4)}


class Event(NamedTuple):
    """A bifurcation or a change of contacts. The point lies at the event or beside it.

    kind: A key of TESTS, or "grazing" (a contact appears or vanishes in flight), or "merging" (two
    contacts with one wall become one, or the reverse).
    before, after: Order of contacts (`Orbit.sequence`) before and after the event.
    """

    kind: str
    point: Point
    before: str
    after: str


def _reversal(point, symmetric):
    """Return a number that is zero where one of `Orbit.cycle_multipliers` is -1.

    There a symmetric orbit loses its symmetry, and any other orbit doubles its period. `symmetric`
    says which of the two kinds of orbits is tested. For an orbit of the other kind return 1.
    """
    orbit = point.orbit
    return _product(orbit.cycle_multipliers + 1) if (orbit.sign < 0) == symmetric else 1.0


def _pairs(point):
    """Return a number that is zero if the product of any two multipliers of the orbit is 1."""
    values = point.orbit.multipliers[: point.orbit.active]
    first, second = PAIRS[len(values)]
    return _product(values[first] * values[second] - 1)


def _product(values):
    """Return the real part of a product of `values`, each scaled down to modulus 1 if larger."""
    return float((values / np.maximum(1, np.abs(values))).prod().real)


# For each kind of bifurcation: a function of a point that is zero at the bifurcation, and the
# tolerance of the place. A larger tolerance is enough at a fold, where the parameter is stationary.
TESTS = {
    "fold": (lambda point: point.tangent[-1], 1e-7),
    "symmetry_breaking": (partial(_reversal, symmetric=True), 1e-11),
    "period_doubling": (partial(_reversal, symmetric=False), 1e-11),
    "neimark_sacker": (_pairs, 1e-11),
}


def bifurcations_between(point_at, start, end, first, last):
    """Return (place, event) for each bifurcation between two points, and how many were missed.

    A place is a distance along the branch or, near a grazing, |Z2| - d0 in an extremum of Z2. The
    points `start` and `end` lie at the places `first` and `last`. `point_at` finds other points.
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
                # If an orbit beside the bifurcation is stable, store this orbit.
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
    """Return a list of the events on a step, and the number of events that were not located."""

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
    """Return whether the two multipliers whose product is closest to 1 are complex conjugates."""
    values = multipliers[np.isfinite(multipliers)]
    first, second = PAIRS[len(values)]
    k = np.argmin(np.abs(values[first] * values[second] - 1))
    one, other = values[first[k]], values[second[k]]
    return abs(one.imag) > COMPLEX and np.isclose(one, other.conjugate())


def _changes_of_contact(point_at, start, end, length):
    """Find changes of the order of contacts by bisection. Return a list of (place, event)."""
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
        # Of the two orbits beside the event, store the one with more contacts.
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
