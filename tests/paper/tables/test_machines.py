"""The table of dampers designed for machines."""

import numpy as np
from helpers.made_up_design import made_up_design

from chatterjee1995.tables.machines import machines


def row(**changed):
    (found,) = machines({"machines": {"made_up": made_up_design(**changed)}}).to_dict("records")
    return found


def test_a_row_states_what_to_build_and_what_it_promises():
    assert row() == {
        "machine": "made_up",
        "loose mass [kg]": 0.6,
        "band [Hz]": "26 to 34",
        "gap, full play [mm]": "7 ± 10 %",
        "advice": "build it",
        "largest displacement without damper [mm]": 10.0,
        "promised displacement [mm]": 1.0,
        "promised for the share of starts": 0.95,
        "largest with the best tuned absorber [mm]": 0.5,
        "largest with this absorber detuned by 10 % [mm]": 0.6,
    }
    other = row(decision="do_not_build", promised_displacement=np.inf)
    assert other["advice"] == "do not build it"
    assert other["promised displacement [mm]"] == "escapes"
