"""Real roots: double roots are kept, complex ones dropped, and none is missed."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.theory.roots import polynomial_roots, smooth_roots


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_near_double_roots_are_told_from_a_near_miss(gap):
    assert len(polynomial_roots([1 - gap**2, -2, 1])) == 2
    assert len(polynomial_roots([1 + gap**2, -2, 1])) == 0


def test_zeros_of_a_function_that_oscillates_ever_faster():
    """sin(1/x) has its zeros at 1/(k pi)."""
    found = smooth_roots(lambda x: np.sin(1 / x), lambda x: 1 + 1 / x, 0.05, 1.0)
    assert_allclose(found, 1 / (np.pi * np.arange(6, 0, -1)), rtol=1e-12)


def test_function_that_is_not_smooth_is_refused():
    with pytest.raises(ArithmeticError, match="degree"):
        smooth_roots(np.abs, np.ones_like, -1.0, 1.3)
