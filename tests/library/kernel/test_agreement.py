"""The kernels against the 80-bit reference: 5 100 random starts, each run over 2 cycles."""

import numpy as np
import pytest
from references import extended
from references.extended.agreement import KERNELS, TOLERANCES, agreement, describe
from references.extended.starts import KINDS

pytestmark = [
    pytest.mark.thorough,
    pytest.mark.skipif(bool(extended.obstacle()), reason=extended.obstacle()),
]

# Tolerance -> largest share of starts for which rounding decides whether a contact takes place.
# Such starts graze a wall, lie on a wall, or have a large Lyapunov exponent.
MOST_APART = {1e-6: 0.45, 1e-9: 0.25, 1e-12: 0.15}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("kernel", KERNELS)
def test_kernel_agrees_with_the_reference(kernel, tolerance, kind):
    """Numbers of contacts agree; states agree within 10 tolerances times the growth of errors."""
    error, differs, apart = agreement(kernel, kind, tolerance)
    wrong = ~apart & (differs | ~(error < 10))
    assert not np.any(wrong), "\n".join(
        f"error {error[i]:.3g}, count {'differs' if differs[i] else 'agrees'}: {describe(kind, i)}"
        for i in np.flatnonzero(wrong)[:5]
    )
    assert np.mean(apart) <= MOST_APART[tolerance]


def test_the_bound_is_tight_enough_to_fail():
    """Runs at a tolerance 1000 times looser exceed the bound in more than 5 % of the starts."""
    loose = agreement("scalar", "usual", 1e-6)
    assert np.mean(loose.error > 10 * 1e-3) > 0.05
