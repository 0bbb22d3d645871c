"""The table of machines in SI units."""

import json

import numpy as np
import pytest

from impact_damper.data.datasets import dataset, flag
from impact_damper.data.variables.variable import OUTCOME
from impact_damper.tables.machines import machines


def made_up(optimum_gap, largest):
    """Two frequencies, the motion at the first of which escapes, and three gaps."""
    data = {
        "bare_displacement": [1.0, 20.0, 2.0],
        "bare_frequency": [19.0, 20.5, 22.0],
        "maximum_displacement": np.array([[np.inf, 3.0], [5.0, np.nan]]),
        "outcome": [[OUTCOME["escaped"], 1], [1, OUTCOME["absent"]]],
        "run_outcome": np.array([[OUTCOME["escaped"], 1], [1, 1]]),
        "swept_frequency": 20.5,
        "gap": [6.0, 8.0, 10.0],
        "quiet_share": [1.0, 0.5, 0.0],
        "largest_displacement": [1.0, largest, 4.0],
        "optimum_gap": optimum_gap,
        "optimum_kind": flag("optimum_kind", "smooth"),
    }
    found = dataset(data, {"frequency": [20.0, 21.0], "clearance": [3.0, 4.0, 5.0]}, {}, "made up")
    made = {"damper_mass": 0.6, "gap": 0.008}
    return found.assign_attrs(machine=json.dumps(made), optimum="in words")


@pytest.mark.parametrize(
    ("optimum_gap", "largest", "share", "shown"),
    [
        (8.5, 2.0, 0.5, 2.0),
        (8.5, np.inf, 0.5, "escapes"),
        (np.nan, 2.0, "no quiet motion", "no quiet motion"),
    ],
)
def test_what_has_no_size_is_told_in_words(optimum_gap, largest, share, shown):
    (row,) = machines({"machines": {"name": made_up(optimum_gap, largest)}}).to_dict("records")
    assert row["largest without damper, mm"] == 20.0 and row["at, Hz"] == 20.5
    assert row["largest with damper, mm"] == 5.0 and row["at, Hz (with damper)"] == 21.0
    assert row["share of starts that escape"] == 0.25 and row["gap (full play), mm"] == 8.0
    assert (row["starts that end quiet near it"], row["largest near it, mm"]) == (share, shown)
