"""The quiet motion between rigid walls, corrected rigid walls (`mended`) and compliant walls."""

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER

from chatterjee1995.figures.rigid_limit import draw_rigid_limit
from chatterjee1995.stages.rigid_limit import rigid_limit
from chatterjee1995.tables.contact import VERDICTS
from chatterjee1995.tables.contact import rigid_limit as table
from impact_damper.data.datasets import flag
from impact_damper.model.settling import Settling


@pytest.fixture(scope="module")
def limit():
    grid = [1.0, 1.95, 2.0], [500.0, 2000.0, 1e4, 1e5, 1e6]
    return rigid_limit(PAPER, INELASTIC, 2.0, *grid, starts=6, settling=Settling())


def test_dataset(limit):
    assert np.isfinite(limit.rigid_error.sel(frequency=2.0)).all()
    own = limit.sel(frequency=2.0, stiffness=2000)
    assert float(own.rigid_error) == pytest.approx(float(limit.own_error), abs=1e-9)
    assert float(limit.own_displacement) == pytest.approx(0.1262368, abs=1e-6)
    assert float(limit.rigid_order.sel(frequency=2.0)) == pytest.approx(0.5, abs=0.01)
    assert float(limit.mended_order.sel(frequency=2.0)) == pytest.approx(1.0, abs=0.01)
    found = [flag("rigid_verdict", f"both_{name}") for name in ("stable", "unstable")]
    both = limit.rigid_verdict.isin([*found, flag("rigid_verdict", "stability_differs")])
    assert not both.all() and (np.isfinite(limit.rigid_error) == both).all()


def test_table_and_figure(limit):
    made = table({"rigid_limit": {"one": limit}})
    row = made.iloc[0]
    verdicts = [f"map cells in which {words}" for words in VERDICTS.values()]
    assert row[verdicts].sum() == row["map cells"] == 15
    assert row["relative error of rigid walls"] == pytest.approx(float(limit.own_error))
    # A map with its colour scale, and the errors at one frequency.
    assert len(draw_rigid_limit(rigid_limit=[limit]).axes) == 3


def test_no_quiet_motion_is_told():
    with pytest.raises(ArithmeticError, match="frequency = 0.3: none of 2 starts leads to"):
        rigid_limit(PAPER, DESIGN, 0.3, [0.3, 0.4], [1e3, 1e4], starts=2, settling=Settling())
