"""The promised displacement: against closed forms, against a brute force, and by another program.

The other program is Boost.odeint, which shares no code with the package.
"""

import numpy as np
import pytest
from helpers.design_tasks import task
from scipy.stats import binom

import impact_damper as idm
from benchmarks import promises
from benchmarks.rivals import odeint_runs
from impact_damper.data.shares import bounding_rank, starts_needed
from impact_damper.design import promise
from impact_damper.design.cells import BLOCK, HORIZON, Cell, Motions, return_level
from impact_damper.design.cells import run as run_cells
from impact_damper.design.confirm import evaluate_gap, find_gap
from impact_damper.design.promise import Promise, beside_peak, is_peak_known
from impact_damper.design.task import NOMINAL

# For machines of `promises.KNOWN`: gap, m (None: search it), least and greatest gap, mm, that are
# good, and the displacement, mm, below which starts stay at these gaps. A search takes up to
# a minute, so short tests search one gap. `make promises` searches all gaps with many starts.
EXAMPLES = {
    "hardening, narrow": (26e-3, (24, 28), 3),
    "board": (1.34e-3, (1.3, 1.4), 0.85),
    "pump": (3.89e-3, (3.8, 4), 3.1),
    "pump, light": (None, (7.664, 8.167), 2.4),
}
NEW = 40  # new starts of another program in each of four cells
needs_odeint = pytest.mark.skipif(
    bool(odeint_runs.obstacle()), reason=odeint_runs.obstacle() or "runs"
)


@pytest.mark.parametrize("share", [0.8, 0.95, 0.99])
def test_a_rank_bounds_the_share(share):
    """The k-th largest of n values is below the quantile if fewer than k values exceed it."""
    for total in range(starts_needed(share) - 1, 400, 7):
        k = bounding_rank(share, total)
        assert k == 0 or binom.cdf(k - 1, total, 1 - share) <= 0.05
        assert binom.cdf(k, total, 1 - share) > 0.05
    assert [bounding_rank(0.95, n) for n in (58, 59, 92, 93, 123, 124)] == [0, 1, 1, 2, 2, 3]


def test_a_rank_bounds_the_quantile_of_drawn_values():
    """Of bounds from 96 exponentially distributed values, 95 % exceed the true quantile."""
    values = np.random.default_rng(1).exponential(size=(4000, 96))
    bounds = np.sort(values, axis=1)[:, -bounding_rank(0.95, 96)]
    assert np.mean(bounds > -np.log(0.05)) == pytest.approx(binom.sf(1, 96, 0.05), abs=0.01)


def test_the_peak_of_a_resonance_is_found_between_points():
    """Linear machine: intervals are split until the peak of the closed form is known to 1 %."""

    def size(f):
        return 1 / np.hypot(1 - f**2, 0.02 * f)

    frequencies, before = np.linspace(0.93, 1.09, 9), 0.0
    for _ in range(12):
        sizes = size(frequencies)
        if is_peak_known(frequencies, sizes, before):
            break
        before, frequencies = sizes.max(), np.union1d(frequencies, beside_peak(frequencies, sizes))
    assert sizes.max() == pytest.approx(50, rel=0.011)


def asked_task(name, **effort):
    """Return the task of a machine in `promises.KNOWN` or `promises.BUILT`."""
    machine, asked = (promises.KNOWN | promises.BUILT)[name]
    return task(machine=idm.Machine(**machine), **asked, **effort)


def allowed(count):
    """Return how many of `count` starts may exceed a bound that holds for 95 % of all starts."""
    return binom.ppf(0.999, count, 0.05)


@pytest.mark.thorough
@needs_odeint
@pytest.mark.parametrize("name", EXAMPLES)
def test_a_design_finds_the_good_gap_and_new_starts_of_another_program_keep_its_promise(name):
    """New starts run at the gap, at both ends of its tolerance, and beside the grid's points."""
    gap, (low, high), known = EXAMPLES[name]
    made = asked_task(name, gap=gap, frequencies=7, candidates=4 if gap else 8, starts=96)
    found = evaluate_gap(made) if gap else find_gap(made)
    gap, promised = float(found["design_gap"]), float(found["promised_displacement"])
    assert low <= gap <= high and promised < known
    exceeded = [
        np.sum(~(promises.new_sizes(made, cell, NEW, number, tolerance=1e-8) <= promised))
        for number, cell in enumerate(promises.cells_of(made, found))
    ]
    assert max(exceeded) <= allowed(NEW)
    assert sum(exceeded) <= allowed(NEW * len(exceeded))


@pytest.mark.long
@needs_odeint
@pytest.mark.parametrize("name", [*promises.KNOWN, *promises.BUILT])
def test_a_searched_gap_keeps_its_promise_for_many_starts_of_another_program(name):
    made = asked_task(name)
    found = find_gap(made)
    if name in EXAMPLES:
        assert float(found["promised_displacement"]) < EXAMPLES[name][2]
    count = promises.STARTS if name in promises.KNOWN else promises.FEWER
    assert max(promises.exceeded(made, found, count)) <= allowed(count) / count


@pytest.mark.thorough
@needs_odeint
@pytest.mark.parametrize("gap", [10, 14, 20])
def test_chaotic_motions_of_one_regime_have_one_bound_that_new_starts_keep(gap):
    cell, made = Cell(1e-3 * gap, 20.55), task(frequencies=3, candidates=4, starts=59)
    motions = run_cells(made, [cell], 59, ("search",))
    (bound,) = motions.largest(1)
    sizes, known = motions.numbers(0)
    for regime in motions.regimes(0):
        assert len(np.unique(sizes[regime])) == 1 and known[regime].all()
    sizes = promises.new_sizes(made, cell, 60, gap, lead=300, tolerance=1e-6)
    assert np.sum(sizes > made.millimetres(bound)) <= 0.05 * 60


@pytest.mark.parametrize("length", [500, 1000])
def test_a_return_level_of_an_exponential_tail(length):
    """Of N exponentially distributed peaks of blocks, on average one exceeds ln N."""
    peaks = np.random.default_rng(length).exponential(size=(20, length))
    levels = [return_level(5 + each) for each in peaks]
    assert np.mean(levels) == pytest.approx(5 + np.log(HORIZON / BLOCK), rel=0.1)


def test_a_rare_motion_is_bounded_with_more_starts(monkeypatch):
    """Made-up motions: 0.8 % of all starts lead to a large motion; two of 96 starts often do."""

    def made_up(task, cells, count, stream, progress=None):
        random = np.random.default_rng([count, *stream[1:]])
        peaks = np.where(random.random((len(cells), count)) < 0.008, 10.0, 1.0)
        shape = peaks.shape
        settled, blocks = np.ones(shape, bool), np.full(len(cells), None)
        given = np.zeros((len(cells), 1)), np.zeros(shape), np.zeros((*shape, 4))
        return Motions(task, *given, settled, peaks, np.zeros((*shape, 4)), blocks)

    monkeypatch.setattr(promise, "run", made_up)
    made = task(frequencies=41, candidates=4, starts=96)
    first = made_up(made, range(len(made.grid)), 96, ("confirmed", 0, 0))
    assert np.sort(first.peaks, axis=1)[:, -2].max() == 10
    found = Promise(made, 8e-3, [NOMINAL], ("confirmed", 0))
    assert found.again and found.size == pytest.approx(made.millimetres(1.0), rel=2e-3)
