"""The quiet orbit, stable or not, on a grid of parameters, and rules for the optimum clearance."""

from typing import NamedTuple

import numpy as np

from chatterjee1995.methods.grid_following import Grid
from impact_damper.motions.records import SYMMETRIC, measured
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, STROBE, polish
from impact_damper.orbits.shooting import newton, shoot
from impact_damper.theory.straight_flight import Flight, flight_of, least_displacement_ratio

CONTACTS = 2  # number of contacts of a quiet orbit in a cycle


class CompliantOrbit(NamedTuple):
    """A symmetric orbit with 2 contacts a cycle. `state` is its state at W T = pi/2."""

    parameters: np.ndarray
    state: np.ndarray
    multiplier: complex
    displacement: float


def compliant_orbit(p, guess, reach, *, tolerance=POLISH_TOLERANCE, asymmetry=SYMMETRIC):
    """Return the `CompliantOrbit` near the state `guess` at W T = pi/2, or None, and a status.

    The state of the orbit differs from the guess by less than `reach`. Half a cycle later the state
    has the opposite sign, with an error below `asymmetry`.
    """
    state = np.array(guess, float)
    converged, _, multiplier = polish(p, state, 1, reach, tolerance)
    if not converged:
        return None, "not_followed"
    record = measured(p, state, 1, tolerance)
    if record["contacts"] != CONTACTS or not record["asymmetry"] < asymmetry:
        return None, "other_contacts"
    return CompliantOrbit(p, state, multiplier, float(record["maximum_displacement"])), "found"


# Phase W T of the states that `find_quiet_orbit` uses. Contacts take place at other phases.
PHASE = 0.75 * np.pi
REACH = 0.05  # largest distance of the state of an orbit from the guess
SHORTEST = 2.0**-12  # shortest step between two cells, divided by the distance of the cells
# The end of a row of orbits is reported as a fold if extrapolation from the last two orbits finds a
# fold less than NEAR * SHORTEST columns beyond the last orbit.
NEAR = 4


class QuietOrbits(NamedTuple):
    """Quiet orbits on a grid. Arrays (rows, columns) are NaN in cells without an orbit.

    multiplier: Dominant eigenvalue of the map "integrate half a cycle, then change the sign". Its
        square is a Floquet multiplier.
    displacement, harmonic: max |Z1|, and the amplitude of the first harmonic of Z1.
    end: Columns (may be fractions) at which the orbits of each row begin and end, shape (rows, 2).
    end_event: What ends the orbits there: map_ends (edge of the grid), fold, contacts_change,
        not_converged, or no_orbit in a row without orbits.
    """

    multiplier: np.ndarray
    displacement: np.ndarray
    harmonic: np.ndarray
    end: np.ndarray
    end_event: np.ndarray


def straight_flight_end(oscillator, clearance, restitution) -> float:
    """Return W at the fold where quiet orbits end, by the theory of straight flight.

    At this fold W^2 d0/f = sqrt(1 + k^2), with k = (pi/2) (1 + e)/(1 - e) and f = F + U W^2. The
    result is infinite if there is no fold.
    """
    if restitution == 1:
        return np.inf
    most = np.hypot(1, np.pi / 2 * (1 + restitution) / (1 - restitution))
    left = clearance - most * oscillator.unbalance
    if left <= 0:
        return np.inf
    return float(np.sqrt(oscillator.force * most / left))


def follow_quiet_orbits(parameters, states) -> QuietOrbits:
    """Follow quiet orbits over a grid of `parameters`, from cells whose `states` are not NaN."""
    grid = Grid(parameters, find_quiet_orbit, shortest=SHORTEST, axes=(1, 0), extrapolating=True)
    for cell in zip(*np.nonzero(np.isfinite(states[..., 0])), strict=True):
        at_strobe = shoot(parameters[cell], states[cell], 1, STROBE)
        orbit, _ = find_quiet_orbit(parameters[cell], at_strobe.at(PHASE))
        if orbit is not None:
            grid.orbits[cell] = orbit
    grid.spread()
    rows, columns = grid.shape
    ends, events = zip(*(_row_ends(grid, row) for row in range(rows)), strict=True)
    multiplier = np.full((rows, columns), complex(np.nan, np.nan))
    displacement, harmonic = np.full((2, rows, columns), np.nan)
    for cell, orbit in grid.orbits.items():
        multiplier[cell] = _dominant_root(orbit)
        displacement[cell] = orbit.record["maximum_displacement"]
        harmonic[cell] = abs(orbit.record["harmonic_displacement"])
    return QuietOrbits(multiplier, displacement, harmonic, np.array(ends), np.array(events))


def find_quiet_orbit(p, guess):
    """Return the quiet orbit near the state `guess` at W T = PHASE, or None, and a status."""
    orbit = newton(shoot(p, guess, 1, PHASE, symmetric=True), REACH)
    if not orbit.converged:
        return None, "not_converged"
    return (orbit, "found") if orbit.record["contacts"] == CONTACTS else (None, "contacts_change")


def _dominant_root(orbit):
    values = np.linalg.eigvals(orbit.matrix)
    value = values[np.argmax(np.abs(values))]
    return complex(value.real, abs(value.imag))


def _row_ends(grid, row):
    columns = [column for first, column in grid.orbits if first == row]
    if not columns:
        return [np.nan] * 2, ["no_orbit"] * 2
    places, events = [], []
    for column, turn in ((min(columns), -1), (max(columns), 1)):
        fraction, event = 0.0, "map_ends"
        if grid.beside((row, column), (0, turn)) is not None:
            fraction, event = _end(grid.follow((row, column), (0, turn)))
        places.append(column + turn * fraction)
        events.append(event)
    return places, events


def _end(followed):
    # `spread` found no orbit in the next cell, so the row ends in this cell. `follow` may find one
    # there, since it can extrapolate from orbits that `spread` found later.
    if followed.arrived:
        return 0.0, "not_converged"
    before, fraction = followed.values
    squares = [np.linalg.det(np.eye(4) - each.matrix) ** 2 for each in followed.orbits]
    if squares[1] < squares[0]:
        ahead = (fraction - before) * squares[1] / (squares[0] - squares[1])
        if ahead < NEAR * SHORTEST:
            return fraction + ahead, "fold"
    return fraction, followed.status


# FIRST_HARMONIC_RATIO is the ratio rm W^2 d0/f (f: forcing amplitude) by rule (18) if the first
# harmonic of Z2 replaces d0 in this rule. The harmonic is 8 d0/pi^2 if the primary mass rests and
# the loose mass flies to and fro at constant speed.
FIRST_HARMONIC_RATIO = np.pi**2 / 8
# An impact changes Z1' by 4 q f/(pi W). q is the `impulse` of a `Flight`, f the forcing amplitude.
# For rigid elastic walls and a machine without damping and spring, max |Z1| is smallest if q is
# IMPULSE. Then |Z1| is equally large at an impact and at the next turning point. TURN is the phase
# W T between them. q and phi = TURN solve q - 1 = cos(phi) - q + 2 q phi/pi, sin(phi) = 2 q/pi.
IMPULSE, TURN = 1.1382168528663819, 0.8104702831754177
CRITERIA = ("displacement", "first_harmonic")  # quantities of Z1; an optimum minimises one
RULES = ("balance", "gap_harmonic", "straight_flight", "elastic", "flight")


def elastic_ratios(flight) -> tuple[float, float]:
    """Return an optimum rm W^2 d0/(forcing amplitude) for each of CRITERIA, or NaN if e < 1."""
    if flight.restitution != 1:
        return np.nan, np.nan
    contact, damping, whole = flight.contact, flight.damping, 1 + flight.mass_ratio
    bend = (2 * IMPULSE - TURN * (np.pi - TURN)) / np.pi * damping
    kink = 1 + ((1 - 2 / np.pi) * contact + bend) / (2 - 2 * TURN / np.pi)
    displacement = whole * IMPULSE * (kink - contact) - flight.mass_ratio
    harmonic = whole * (1 - contact) * np.pi**2 / 8 - flight.mass_ratio
    return displacement, harmonic


def least_harmonic_ratio(flight) -> float:
    """Return rm W^2 d0/f at which the first harmonic of Z1 in a `Flight` is smallest.

    f is the forcing amplitude. At rigid walls an impact with the impulse q comes at a phase u for
    which sin(u) = l q, where l is `loss`. If contacts take time, the impact comes earlier by
    `setback`. The forcing is largest at the phase `forced_lag`. Let n be `forced_lag` + `setback`.
    The sum of forcing and impact forces has the first harmonic f (1 - c q exp(i (n - u))), with
    c = 8/pi^2. The first harmonic of Z1 is proportional to this one. Its modulus is smallest if
    tan(2 u) = 2 l cos(n)/(c - 2 l sin(n)).
    """
    factor = 8 / np.pi**2
    loss = flight.loss
    if loss == 0:
        return float(flight.ratio(1 / factor))
    shift = flight.forced_lag + flight.setback
    angle = np.arctan2(2 * loss * np.cos(shift), factor - 2 * loss * np.sin(shift)) / 2
    return float(flight.ratio(np.sin(angle) / loss))


def rule_ratios(oscillator, damper, frequency):
    """Return an array with optima of rm W^2 d0/(forcing amplitude) by several rules.

    Each row is for one of CRITERIA, and each column for one of RULES. `balance` is rule (18).
    `gap_harmonic` is FIRST_HARMONIC_RATIO. `flight` is the optimum of the damper's `Flight`.
    `straight_flight` is the optimum of a `Flight` between rigid walls, for a machine that
    has neither damping nor a linear spring. `elastic` is `elastic_ratios`, and NaN if e < 1.
    """
    flight = flight_of(oscillator, damper, frequency)
    straight = Flight(damper.mass_ratio, damper.restitution)
    elastic = elastic_ratios(flight)
    return np.array(
        [
            [1.0, FIRST_HARMONIC_RATIO, least(straight), elastic[i], least(flight)]
            for i, least in enumerate((least_displacement_ratio, least_harmonic_ratio))
        ]
    )
