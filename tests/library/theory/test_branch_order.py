"""Solutions found in any order are put on branches that do not jump."""

import numpy as np
from numpy.testing import assert_allclose

from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.harmonic_balance import branches_over, harmonic_balance_response


def test_roots_of_a_cubic_lie_on_three_branches():
    """The real roots of x^3 - x = s: between the folds at s = -+2/sqrt(27) there are three."""
    generator = np.random.default_rng(1)
    levels, rows = np.linspace(-1, 1, 201), []
    for level in levels:
        roots = np.roots([1, 0, -1, -level])
        rows.append(generator.permutation(roots[abs(roots.imag) < 1e-9].real)[:, None])
    numbers = branches_over(rows)
    assert max(row.max() for row in numbers) == 2
    fold = 1 / np.sqrt(3)
    for level, row, places in zip(levels, rows, numbers, strict=True):
        for (x,), place in zip(row, places, strict=True):
            kind = 0 if x < -fold else (1 if x > fold else 2)
            first = {0: 0, 1: None, 2: None}[kind]
            assert first is None or place == first, (level, x)
    middle = {
        p
        for row, n in zip(rows, numbers, strict=True)
        for (x,), p in zip(row, n, strict=True)
        if abs(x) < fold - 0.02
    }
    assert len(middle) == 1


def test_solutions_of_harmonic_balance_are_curves():
    """Branches are smooth. Without the damper each is stable or unstable from fold to fold."""
    found = harmonic_balance_response(Oscillator(0.215), Damper(0.12, 2.0), np.linspace(1, 3, 201))
    unstable = found.free_stability.values == flag("free_stability", "unstable")
    exists = np.isfinite(found.free_amplitude.values)
    assert exists.shape[1] == 3
    assert_allclose(np.sort(unstable.sum(0) / exists.sum(0)), [0, 0, 1])
    for name in ("amplitude", "free_amplitude"):
        values = found[name].values
        kept = np.isfinite(values)
        # each column is one interval of frequencies
        assert np.all(np.abs(np.diff(kept.astype(int), axis=0)).sum(axis=0) <= 2)
        # amplitudes change little from one frequency to the next
        steps = np.abs(np.diff(values, axis=0))
        assert np.nanmax(steps) < 0.2
