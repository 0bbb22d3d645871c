"""Locate bifurcations (zeros of test functions) and changes of contact on a step of a branch.

The place of an event is the distance along the step's first tangent or, in a grazing, the height.
"""

from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.model.packed import FREQUENCY
from impact_damper.orbits.continuation import Point, point_at_distance

# Largest tolerance of the place of a bifurcation, divided by the length of the step.
FINE = 1e-3
# Tolerance of the place of a change of contact, divided by max(1, length of the step).
PLACE = 1e-12
# A multiplier counts as complex if the modulus of its imaginary part exceeds COMPLEX.
COMPLEX = 1e-6
# Orbits beside a bifurcation may be stable if no multiplier has a modulus above 1 + NEAR_CIRCLE.
NEAR_CIRCLE = 1e-3
# Two contacts with one wall merge if the flight between them is below MERGED forcing cycles.
MERGED = 1e-3
# Largest number of changes of contact that are located on one step.
MOST_CHANGES = 8
# Indices i < j of all pairs of multipliers, for 2 and for 4 multipliers.
PAIRS = {count: np.triu_indices(count, 1) for count in (2, 4)}


class Event(NamedTuple):
    """An event of a branch, with the walls touched (`Orbit.sequence`) before and after the event.

    Kind "grazing": a contact appears or vanishes in flight. Kind "merging": two contacts with one
    wall become one contact, or one contact parts in two. Further kinds: the keys of TESTS.
    """

    kind: str
    point: Point
    before: str
    after: str


def _reversal(point, symmetric):
    """Return the `_product` of mu + 1 over all `cycle_multipliers` mu of the orbit, or 1.

    At mu = -1 a symmetric orbit (`sign` -1) loses its symmetry, and any other orbit doubles its
    period. If `symmetric`, return 1 for asymmetric orbits; otherwise return 1 for symmetric orbits.
    """
    orbit = point.orbit
    return _product(orbit.cycle_multipliers + 1) if (orbit.sign < 0) == symmetric else 1.0


def _pairs(point):
    """Return the `_product` of mu_i mu_j - 1 over all pairs of multipliers."""
    values = point.orbit.multipliers[: point.orbit.active]
    first, second = PAIRS[len(values)]
    return _product(values[first] * values[second] - 1)


def _product(values):
    """Return the real part of the product of `values`; moduli above 1 are first reduced to 1."""
    return float((values / np.maximum(1, np.abs(values))).prod().real)


# For each kind of bifurcation: a function of a point that is zero at the bifurcation, and the
# largest tolerance of the place. The tolerance is larger at a fold. Newton's method is nearly
# singular at a fold, and the parameter changes only with the square of the distance from the fold.
TESTS = {
    "fold": (lambda point: point.tangent[-1], 1e-7),
    "symmetry_breaking": (partial(_reversal, symmetric=True), 1e-11),
    "period_doubling": (partial(_reversal, symmetric=False), 1e-11),
    "neimark_sacker": (_pairs, 1e-11),
}


def bifurcations_between(point_at, start, end, first, last):
    """Return pairs (place, event) of bifurcations between two points, and the number missed."""
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
                # Move the point to the stable side of the bifurcation, if one side is stable.
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
    """Return whether the two multipliers with the product nearest to 1 are complex conjugates."""
    values = multipliers[np.isfinite(multipliers)]
    first, second = PAIRS[len(values)]
    k = np.argmin(np.abs(values[first] * values[second] - 1))
    one, other = values[first[k]], values[second[k]]
    return abs(one.imag) > COMPLEX and np.isclose(one, other.conjugate())


def _changes_of_contact(point_at, start, end, length):
    """Return (place, event) pairs of the changes of `Orbit.sequence` on a step, by bisection."""
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
        # Store the event with the orbit on the side with more contacts.
        sides = point_at(inner), point_at(outer)
        point = max(sides, key=lambda side: len(side.orbit.sequence))
        kind = _contact_event(point.orbit)
        located.append((outer, Event(kind, point, before, after.sequence)))
        inner, before = outer, after.sequence
    return located


def _contact_event(orbit):
    """Return the kind of event, merging or grazing, at which an orbit's slowest contact appears."""
    contacts = orbit.contacts
    k = int(np.argmin(np.abs(contacts[:, 3])))
    period = 2 * np.pi / orbit.p[FREQUENCY]
    flight = (contacts[k, 1] - contacts[k - 1, 2]) % (orbit.periods * period)
    merging = contacts[k, 0] == contacts[k - 1, 0] and flight < MERGED * period
    return "merging" if merging else "grazing"
