"""Impulses on a machine, compared with a simulator that shares no code with the library."""

import numpy as np
import pytest
from helpers.design_tasks import needs_compiler, task
from references.built import BOARD, by_program

from impact_damper.design.cells import Cell, run
from impact_damper.design.shocks import BLOCK, SHOCKS, convergence_times, shocks
from impact_damper.design.task import labelled
from impact_damper.motions.strobe_map import strobe_time

# At this frequency the board with the light damper has a large motion beside the small motion.
FREQUENCY, GAP, PROMISED = 21.5, 4.0, 2.5
CYCLES, LEAD = 500, 450


@pytest.fixture(scope="module")
def made():
    damper = {"mass": 0.12, "restitution": 0.6, "contact": 1e6}
    return task(machine=BOARD, **damper, band=(21.3, 21.7), frequencies=3, starts=59)


@pytest.fixture(scope="module")
def motions(made):
    return run(made, [Cell(1e-3 * GAP, FREQUENCY)], 59, ("shocks",))


def moved(made, state, cycles, lead):
    """Return the largest displacement by the other program, mm, from a scaled state on."""
    units = [made.scales.to_si(1.0, kind) for kind in ("displacement", "velocity")] * 2
    given = made.machine, made.damper(1e-3 * GAP), FREQUENCY, state * units
    start = strobe_time(made.packed(1e-3 * GAP, FREQUENCY)) * made.scales.to_si(1.0, "time")
    return 1e3 * by_program(*given, cycles, lead, start=start * FREQUENCY)


@needs_compiler
def test_motions_return_in_the_same_block_of_cycles(made, motions):
    states = np.tile(motions.states[0, np.argmin(motions.peaks[0])], (6, 1))
    states[:, 1::2] += np.linspace(0.05, 0.5, 6)[:, None]
    promised = PROMISED / made.millimetres(1.0)
    times = convergence_times(made, motions.parameters[0], states, promised)
    assert np.isfinite(times).all()
    for state, cycles in zip(states, times, strict=True):
        assert moved(made, state, cycles + BLOCK, cycles) <= PROMISED
        assert cycles == 0 or moved(made, state, cycles, cycles - BLOCK) > PROMISED


@needs_compiler
def test_impulses_lead_away_as_in_another_program(made, motions):
    values = {"design_gap": GAP, "promised_frequency": FREQUENCY, "promised_displacement": PROMISED}
    found = shocks(made, labelled(values))
    state = motions.states[0, np.argmin(motions.peaks[0])]
    away, changes = [], found.shock_impulse.values / made.scales.to_si(1.0, "impulse")
    for change in changes:
        pushed = state + np.array([0.0, change, 0.0, change])
        away.append(moved(made, pushed, CYCLES, LEAD) > PROMISED)
    expected = np.isinf(found.shock_return.values)
    assert 0 < expected.sum() < len(expected)
    # Rounding errors decide on which of the two motions a chaotic transient ends.
    assert np.mean(expected == away) > 0.9
    # The smallest impulse that leads away lies between two of the grid, after chaotic transients.
    critical = float(found.critical_shock) / made.scales.to_si(1.0, "impulse")
    step = np.diff(changes).min() / SHOCKS

    def lead_away(shocks):
        pushed = [state + np.array([0.0, sign * shock] * 2) for sign in (-1, 1) for shock in shocks]
        return any(moved(made, each, CYCLES, LEAD) > PROMISED for each in pushed)

    assert lead_away(critical + step * np.arange(8))
    assert not lead_away(critical - step * np.arange(2, 17, 2))
    assert critical <= np.abs(changes)[away].min()
