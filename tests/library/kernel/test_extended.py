"""The 80-bit reference program against extrapolation, and against stored motions."""

import json
import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER, STARTS
from numpy.testing import assert_allclose
from references import extended
from references.extended import scenes

from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    CUBIC,
    DAMPING,
    DASHPOT,
    FORCE,
    FREQUENCY,
    INVERSE_MASS_RATIO,
    STIFFNESS,
    UNBALANCE,
    pack,
)
from impact_damper.model.parameters import Damper, Oscillator

pytestmark = pytest.mark.skipif(bool(extended.obstacle()), reason=extended.obstacle())

Real = np.longdouble
DIGITS = 2e-17  # the reference's error is this number times the growth of errors

MOTIONS = {
    **{name: (pack(PAPER, damper, w), state, 3) for name, (damper, w, state) in STARTS.items()},
    "violent": (pack(PAPER, DESIGN, 1.2), (1.2078, -1.7032, -0.3208, -0.7220), 3),
    "in contact": (pack(Oscillator(0.1, 1.5), INELASTIC, 0.7), (0.4, -0.3, 1.1, 2.0), 1),
    "dead": (pack(Oscillator(0.02), Damper(2.0, 0.3, 0.3, 50.0), 3.0), (0.4, -3.0, -0.35, 0.0), 3),
}


def field(p, touching, t, y):
    """Return the derivative of the state y by equations (3), (4) and (20) to (24).

    In contact y[2] is the penetration of the wall in place of Z2.
    """
    p = p.astype(Real)
    force = p[CONTACT_STIFFNESS] * y[2] + p[DASHPOT] * y[3] if touching else Real(0)
    pull = (p[FORCE] + p[UNBALANCE] * p[FREQUENCY] ** 2) * np.cos(p[FREQUENCY] * t) - force
    pull -= p[DAMPING] * y[1] + p[STIFFNESS] * y[0] + p[CUBIC] * y[0] ** 3
    return np.array([y[1], pull, y[3], pull - p[INVERSE_MASS_RATIO] * force])


def extrapolate(p, touching, t, y, length, columns=8):
    """Return the state after a step of the method of Gragg, Bulirsch and Stoer."""
    table = []
    for n in range(2, 2 * columns + 1, 2):
        h = length / n
        before, now = y, y + h * field(p, touching, t, y)
        for i in range(1, n):
            before, now = now, before + 2 * h * field(p, touching, t + i * h, now)
        row = [(before + now + h * field(p, touching, t + length, now)) / 2]
        for j, last in enumerate(table, 1):
            ratio = (Real(n) / (n - 2 * j)) ** 2
            row.append(row[j - 1] + (row[j - 1] - last) / (ratio - 1))
        table = row
    return table[-1]


@pytest.mark.parametrize("name", MOTIONS)
def test_replay_by_extrapolation(name):
    """Extrapolation, another method, integrates from each logged event to the next event."""
    p, state, periods = MOTIONS[name]
    start = 0.5 * math.pi / p[FREQUENCY]
    times = start + 2 * math.pi / p[FREQUENCY] * np.arange(1, periods + 1)
    run = extended.run(p, state, start, times)
    allowed = 10 * DIGITS * run.growth
    stops = [(Real(t), 0) for t in times]
    for wall, begin, end, *_ in run.contacts:
        stops += [(begin, int(wall)), (end, int(wall))]
    stops = sorted(stop for stop in stops if start < stop[0] <= times[-1])
    y, t = np.array(state, Real), Real(start)
    side = int(run.contacts[0, 0]) if len(run.contacts) and run.contacts[0, 1] == start else 0
    in_contact = 0.3 / math.sqrt(1 + p[CONTACT_STIFFNESS] * (1 + p[INVERSE_MASS_RATIO]))
    samples = []
    for stop, wall in stops:
        pieces = math.ceil((stop - t) / (in_contact if side else 0.05))
        origin = side * p[CLEARANCE] if side else 0
        y[2] -= origin
        length = (stop - t) / pieces
        for _ in range(pieces):
            y = extrapolate(p, side, t, y, length)
            height = side * y[2] if side else abs(y[2]) - p[CLEARANCE]
            assert (height if side else -height) > -allowed
            t += length
        y[2] += origin
        t = stop
        if wall:
            assert abs(wall * y[2] - p[CLEARANCE]) < allowed
            speed = run.contacts[np.any(run.contacts[:, 1:3] == stop, axis=1), 3 + (side != 0)]
            assert abs(y[3] - speed) < allowed
            side = 0 if side else wall
        else:
            samples.append(y.copy())
    assert np.max(np.abs(np.array(samples) - run.states)) < allowed


@pytest.mark.parametrize("scene", list(scenes.configured_scenes()), ids=lambda scene: scene[0])
def test_stored_references_are_what_the_program_gives(scene):
    """The last digits may differ from one C library to another."""
    name, *motion = scene
    stored, made = json.loads(scenes.FILE.read_text())[name], scenes.reference(*motion)
    assert list(stored) == list(made)
    assert stored["parameters"].items() <= made["parameters"].items()
    for key in list(made)[1:]:
        allowed = 1e-11 if key == "contact_times" else 2e-14
        assert_allclose(stored[key], made[key], rtol=0, atol=allowed)
