"""Models of motions: rigid walls, harmonic balance, shooting. `work` counts operations."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from chatterjee1995.methods import fourier
from chatterjee1995.methods.integrator import Run, stopped
from chatterjee1995.methods.integrators.taylor import (
    FLIGHT,
    MEETING,
    all_steps,
    counted,
    step_work,
    work_of_steps,
)
from chatterjee1995.methods.many_harmonics import Balance, Solution, solve, state_of
from chatterjee1995.methods.rigid_impacts import (
    MOST_IMPACTS,
    mended_orbit,
    rebound,
    rigid_map,
    rigid_orbit,
    without_dashpot,
)
from impact_damper.kernel.single import step, workspace
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import SPRING_POWER
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, strobe_time
from impact_damper.orbits.shooting import find_orbit
from impact_damper.theory import single_harmonic
from impact_damper.theory.free_oscillator import free_solutions

# Numbers of operations to find all solutions of (7), and to find all roots of (14).
FULL_WORK, RIGID_WORK = 100 * 130 + 10 * 32**3, 10 * (6**3 + 5**3) + 6 * 10 * 12
REACH = 10.0  # largest difference of a rigid orbit's state from the first guess, in each component


class Model(NamedTuple):
    """A steady motion: state at W T = pi/2, phases W T at which contacts begin, and max |Z1|."""

    status: str
    operations: float
    state: np.ndarray
    contact_phases: np.ndarray
    displacement: float


def rigid(p, restitution, start, t, periods, tolerance):
    """Run from `start` at t with rigid walls; return a `Run` with max |Z1| of each cycle."""
    p = without_dashpot(p)
    y, none, work = start.copy(), np.empty((0, 4)), workspace()
    period, counts = 2 * math.pi / p[FREQUENCY], [0, 0, 0]
    began, peaks = [], []
    for k in range(periods):
        _, _, impacts, _, _, largest = rigid_map(p, restitution, y, tolerance)
        peaks.append(largest)
        if impacts == MOST_IMPACTS:
            return stopped("failed", work_of_steps(counts))
        now, end = t, t + period
        while now < end:
            length, side = step(p, y, 0, now, end - now, tolerance, work)
            now = end if length >= end - now else now + length
            counts[FLIGHT if side == 0 else MEETING] += 1
            if side != 0:
                began.append(now + k * period)
                rebound(p, restitution, y, none, now)
    middles = t + period * (np.arange(periods) + 0.5)
    peaks = np.array(peaks)
    done = work_of_steps(counts), y, np.array(began), middles, peaks, float(np.max(peaks))
    return Run("ended", *done)


def without(status, work=0.0):
    """Return the `Model` of a method that finds no motion. The status says why."""
    return Model(status, work, np.full(4, np.nan), np.empty(0), np.nan)


def of_coefficients(balance, coefficients, work):
    """Return the `Model` of a solution of harmonic balance with these Fourier coefficients."""
    state = state_of(Solution(balance, coefficients, "", 0))
    rows = balance.contacts(coefficients)
    phases = rows[:, 1] if balance.damper is not None else np.empty(0)
    largest = fourier.largest(coefficients[0], balance.harmonics)
    return Model("ended", work, state, phases, largest)


def rigid_balance(oscillator, damper, frequency, state):
    """Return the solution of (13) and (14) nearest to `state`, as a `Model`. Only for e = 1."""
    if damper is None or damper.restitution != 1:
        return without("not_applicable")
    roots = single_harmonic.rigid_solutions(oscillator, damper, frequency)
    models = []
    for a, _, phase in zip(*roots, strict=True):
        if a <= damper.clearance:
            turn = np.exp(1j * (np.pi / 2 + phase)) * np.array([1, 1j * frequency])
            at = np.concatenate([a * turn.real, damper.clearance * turn.real])
            touching = np.array([-phase, np.pi - phase]) % (2 * np.pi)
            models.append(Model("ended", RIGID_WORK, at, touching, abs(a)))
    nearest = min(models, key=lambda each: np.max(np.abs(each.state - state)[:2]), default=None)
    return nearest or without("failed", RIGID_WORK)


def full_balance(oscillator, damper, frequency, state):
    """Return the solution of (7) nearest to `state`, as a `Model`. Dampers must have e = 1."""
    if damper is not None and damper.restitution != 1:
        return without("not_applicable")
    coefficients, work = nearest_term(oscillator, damper, frequency, state)
    if coefficients is None:
        return without("failed", work)
    return of_coefficients(Balance(oscillator, damper, frequency, 1), coefficients, work)


def nearest_term(oscillator, damper, frequency, state):
    """Return coefficients of the solution of (7) nearest to `state`, and a count of operations."""
    if damper is None:
        work = 2 * 10 * 3**3
        solutions = free_solutions(oscillator, frequency)
        sizes = solutions.amplitude[:, None]
    else:
        work = FULL_WORK
        elastic = replace(damper, restitution=1.0)
        solutions = single_harmonic.impacting_solutions(oscillator, elastic, frequency)
        sizes = np.stack([solutions.amplitude, solutions.relative_amplitude], axis=1)
    terms = [
        size[:, None] * np.exp(1j * phase) / 2
        for size, phase in zip(sizes, solutions.phase, strict=True)
    ]

    def away(coefficients):
        turned = 2j * coefficients[0, 0] * np.array([1, 1j * frequency])
        return np.max(np.abs(turned.real - state[:2]))

    return min(terms, key=away, default=None), work


def many_harmonics(oscillator, damper, frequency, state, highest):
    """Return a dict: highest harmonic (3, 7, 15, ...) -> `Model`; empty if (7) has no solution."""
    coefficients, work = nearest_term(oscillator, damper, frequency, state)
    models = {}
    if coefficients is None:
        return models
    count = 3
    while count <= highest:
        balance = Balance(oscillator, damper, frequency, count)
        solution = solve(balance, coefficients)
        work += solution.iterations * newton_work(balance)
        if solution.status == "converged":
            coefficients = solution.coefficients
            models[count] = of_coefficients(balance, coefficients, work)
        else:
            models[count] = without("failed", work)
        count = 2 * count + 1
    return models


def newton_work(balance):
    """Return the number of operations of one step of Newton's method for a balance."""
    n, top = balance.unknowns, balance.highest
    samples = np.repeat([16 * top, (SPRING_POWER + 1) * top], [2, 3])
    return 2 / 3 * n**3 + 12 * n**2 + float(np.sum(5 * samples * np.log2(samples)))


def rigid_impacts(oscillator, damper, frequency, start):
    """Return two models of an orbit near `start`, as a dict.

    In "rigid" the walls are rigid. In "rigid_mended" restitution and clearance of the rigid walls
    are corrected, so that the walls imitate compliant ones (docs/explanation/methods.md).
    """
    if damper is None:
        return dict.fromkeys(("rigid", "rigid_mended"), without("not_applicable"))
    system = oscillator, damper, frequency
    orbit, _ = rigid_orbit(*system, start.state, REACH)
    better, _ = (None, "") if orbit is None else mended_orbit(*system, orbit, REACH)
    models, work, each = {}, start.operations, None
    for name, found in (("rigid", orbit), ("rigid_mended", better)):
        if found is None:
            models[name] = without("failed", work)
            continue
        given = found.p, found.restitution, found.state, strobe_time(found.p)
        run = rigid(*given, 1, POLISH_TOLERANCE)
        # `each`: operations of a call of `rigid_map`, which also integrates variational equations.
        each = each or run.operations / step_work(FLIGHT) * step_work(FLIGHT, tangents=True)
        work += found.maps * each
        phases = frequency * run.contact_times % (2 * math.pi)
        models[name] = Model("ended", work, found.state, phases, found.displacement)
    return models


def shooting(oscillator, damper, frequency, start):
    """Return the `Model` of the exact orbit, found by shooting from the model `start`."""
    p = pack(oscillator, damper, frequency)
    orbit = find_orbit(p, start.state)
    steps, _ = all_steps(p, start.state, strobe_time(p), 1, POLISH_TOLERANCE)
    work = start.operations + orbit.maps * work_of_steps(counted(steps), tangents=True)
    if not orbit.converged:
        return without("failed", work)
    phases = p[FREQUENCY] * orbit.contacts[:, 1] % (2 * math.pi) if orbit.touching else np.empty(0)
    largest = float(orbit.record["maximum_displacement"])
    return Model("ended", work, orbit.strobe_states[0], phases, largest)
