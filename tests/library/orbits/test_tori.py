"""Tori at Neimark-Sacker points, compared with the normal form and with long motions.

A torus surrounds an orbit, and motions on it revolve around the orbit.

Multipliers are Floquet multipliers.
"""

import itertools
import math

import numpy as np
import pytest
from helpers.known_orbits import INELASTIC, PAPER
from helpers.sampling import sample

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper
from impact_damper.motions.undecided import birkhoff_average
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit import STROBE, TURN
from impact_damper.orbits.shooting import find_orbit, shoot
from impact_damper.orbits.tori import torus_behind

# Damper, frequency, period, phase and state of a stable orbit, and the range in which it loses its
# stability at a Neimark-Sacker point.
STABLE = (1.6, 3, STROBE, (0.7796012138, 0.1703671945, 0.8163322819, -0.9718488376))
UNSTABLE = (1.5854, 1, 5.692186, (0.1334, 3.3404, 0.1667, 1.2741))
POINTS = {
    "stable": (INELASTIC, *STABLE, (1.58, 1.61)),
    "unstable": (Damper(0.25, 1.0), *UNSTABLE, (1.56, 1.59)),
}


def branch_point(name):
    """Return the `continuation.Point` at the first Neimark-Sacker point of a branch."""
    damper, frequency, period, phase, state, span = POINTS[name]

    def family(value):
        return pack(PAPER, damper, value)

    orbit = find_orbit(family(frequency), state, period, phase)
    assert orbit.stable
    branch = follow_branch(family, orbit, frequency, span)
    return next(event.point for _, event in branch.events if event.kind == "neimark_sacker")


@pytest.fixture(scope="module", params=POINTS)
def case(request):
    point = branch_point(request.param)
    return request.param, point, torus_behind(point)


def form(orbit, *vectors, step=2e-3):
    """Return the second or third derivative of an orbit's map along complex vectors."""

    def derivative(directions):
        total = np.zeros(4)
        for signs in itertools.product((-1, 1), repeat=len(directions)):
            away = step * np.tensordot(signs, directions, 1)
            _, end = shoot(orbit.p, orbit.state + away, orbit.periods, orbit.phase)
            total += math.prod(signs) * end
        return total / (2 * step) ** len(directions)

    parts = [((1, v.real), (1j, v.imag)) for v in map(np.asarray, vectors)]
    return sum(
        math.prod(factor for factor, _ in chosen) * derivative([part for _, part in chosen])
        for chosen in itertools.product(*parts)
    )


def pair_of(orbit):
    """Return the multiplier nearest to the unit circle with its right and its left eigenvector."""
    values, vectors = np.linalg.eig(orbit.monodromy)
    k = np.argmin(np.abs(np.abs(values) - 1) + 9 * (values.imag <= 0))
    return values[k], vectors[:, k], np.linalg.inv(vectors)[k]


def amplitudes(orbit, start, count):
    """Return the amplitudes in the plane of the pair after each period of an orbit."""
    _, right, left = pair_of(orbit)
    begin, period = orbit.phase / orbit.p[FREQUENCY], TURN / orbit.p[FREQUENCY]
    times = begin + orbit.periods * period * np.arange(1, count + 1)
    states, _ = sample(orbit.p, orbit.state + start * right.real, begin, times)
    return 2 * np.abs((states - orbit.state) @ left)


def test_growth_is_the_coefficient_of_the_normal_form(case):
    """The coefficient is computed from second and third difference quotients of the map.

    The formula is (5.52) of Kuznetsov, Elements of Applied Bifurcation Theory.
    """
    name, point, torus = case
    orbit = point.orbit
    multiplier, right, left = pair_of(orbit)
    both, conjugate = np.eye(4), right.conj()
    slow = np.linalg.solve(both - orbit.monodromy, form(orbit, right, conjugate))
    fast = np.linalg.solve(multiplier**2 * both - orbit.monodromy, form(orbit, right, right))
    cubic = form(orbit, right, right, conjugate)
    cubic = cubic + 2 * form(orbit, right, slow) + form(orbit, conjugate, fast)
    # In the normal form the state is z right plus its conjugate, and its amplitude is 2 |z|.
    growth = (left @ cubic / multiplier / 2).real / 4
    assert torus.kind == name
    assert torus.growth == pytest.approx(growth, rel=0.02)
    assert torus.angle == pytest.approx(np.angle(multiplier) / TURN, abs=1e-9)


def test_rotation_number_tends_to_the_angle_of_the_multiplier():
    torus = torus_behind(branch_point("stable"))
    assert torus.error < 1e-8 and abs(torus.number - torus.angle) > 2e-5
    assert torus.limit == pytest.approx(torus.angle, abs=5e-6)


def test_stable_torus_has_the_amplitude_that_the_growth_predicts():
    """Motions that begin inside and outside the torus approach it."""
    point = branch_point("stable")
    torus = torus_behind(point)
    orbit = point.problem.at_value(point, torus.value).orbit
    size = math.sqrt(math.log(abs(pair_of(orbit)[0])) / -torus.growth)
    for start in (0.7, 1.3):
        found = amplitudes(orbit, start * size, 3000)[-1000:]
        assert birkhoff_average(found) == pytest.approx(size, rel=0.05)


def test_unstable_torus_parts_motions_that_return_from_motions_that_leave():
    """Around a stable orbit motions return to it from inside the torus and leave from outside.

    The amplitude of the torus follows from the growth.
    """
    point = branch_point("unstable")
    torus = torus_behind(point)
    orbit = point.problem.at_value(point, point.value + 2e-4).orbit
    decay = -math.log(abs(pair_of(orbit)[0]))
    size = math.sqrt(decay / torus.growth)
    assert orbit.stable and size < 0.05
    inside, outside = (amplitudes(orbit, start * size, int(1 / decay)) for start in (0.8, 1.25))
    assert inside[-1] < 0.8 * inside[0] and outside[-1] > 1.2 * outside[0]
    assert math.isnan(torus.value)
