"""Tables: a row for each computed case; files are complete and reproducible."""

import numpy as np
import pandas as pd
import pytest
from helpers.made_up import policies, world
from helpers.made_up_design import made_up_design
from helpers.made_up_orbits import branch, branches

from chatterjee1995.tables import balance, clearance, migration, responses
from chatterjee1995.tables import branches as table_branches
from chatterjee1995.tables.files import save_table
from chatterjee1995.tables.machines import machines
from impact_damper.data.datasets import flag


@pytest.fixture(scope="module")
def data():
    return world()


def test_harmonic_balance(data):
    table = balance.harmonic_balance(data).set_index("curve")
    assert len(table) == len(data["harmonic_balance"])
    assert table.loc["figure_05a", "rm Ωp^2 d0"] == pytest.approx(1)
    assert table.loc["figure_03b", "d0 by rule (19)"] == pytest.approx(1 / (0.12 * 2.1**2))


def test_optimum(data):
    table = clearance.optimum(data).set_index("sweep")
    assert len(table) == len(data["optimum"])
    assert table.loc["0.107_0.12_1.0", "excess over (18)"] == pytest.approx(0.05)
    assert (table["kind of optimum"] == "kink").all()


def test_subharmonic(data):
    table = responses.subharmonic(data)
    free = table[table.damper == "off"].set_index("curve")
    assert free.loc["free_h215", "stable from Ω"] == pytest.approx(0.8 * 2)
    assert free.loc["free_h215", "stable to Ω"] == pytest.approx(1.1 * 2)
    damped = table[table.curve == "figure_05c"]
    assert list(damped.branch) == ["all", "4"]
    assert list(damped["largest displacement max |Z1|"]) == pytest.approx([0.1, 0.1])
    assert damped["largest ratio to free max |Z1|"].iloc[0] == pytest.approx(0.1 / 0.8)
    assert list(table[table.curve == "figure_05a"].branch) == ["all"]


def closed(frequency, stable):
    """Return one closed branch."""
    frequency, stable = np.append(frequency, frequency[0]), np.append(stable, stable[0])
    return branches(branch(frequency, 1.0, stable=stable), parameters={"damping": 0.1})


@pytest.mark.parametrize("start", range(8))
def test_stable_parts_of_a_closed_branch_do_not_depend_on_its_first_orbit(start):
    frequency = np.roll([1.0, 1.1, 1.2, 1.3, 1.25, 1.2, 1.1, 1.05], start)
    stable = np.roll([True, True, False, False, False, True, False, True], start)
    made = closed(frequency, stable)
    table = table_branches.orbits({"branches": {"closed": made}})
    assert table.loc[0, "stable Ω"] == "1 to 1.1, 1.2 to 1.2"


def test_an_end_that_is_left_open_has_its_reason():
    made = closed([1.0, 1.1], [True, True])
    ends = [[flag("branch_end", "unstable"), flag("branch_end", "range_ends")]]
    left = made.assign(branch_end=made["branch_end"].copy(data=ends))
    table = table_branches.orbits({"branches": {"closed": made, "left": left}}).set_index("curve")
    assert table["one end"]["closed"] == "closed" and table["other end"]["left"] == "range ends"
    assert table["one end"]["left"].startswith("left among unstable orbits, since")


def test_migration(data):
    case = data["migration"]["figure_16"].assign(damped_contacts=("damped", [np.nan, 0.0]))
    cases = data["migration"] | {"figure_16": case}
    table = migration.migration({"migration": cases}).set_index(["case", "released from"])
    assert len(table) == 2 * len(cases)
    assert set(table.loc["figure_16"].index) == {"unsettled", "quiet, without contact"}
    row = table.loc["figure_15", "quiet"]
    assert row["share to the subharmonic"] == 0.5
    assert row["runs that arrive"] == 1
    assert row["median time [cycles]"] == pytest.approx(150)


def test_release_scan(data):
    table = migration.release_scan(data).set_index(["scan", "released from", "leads to"])
    both = table.loc["wide", "quiet", "non-resonance, subharmonic"]
    assert both["at Ω"] == "1.5, 1.7 to 1.8"
    assert both["frequencies"] == 3
    assert both["share to the subharmonic"] == 0.5
    assert table.loc["wide", "quiet", "non-resonance"]["at Ω"] == "1.6"
    assert table.loc["wide", "unsettled", "subharmonic"]["at Ω"] == "1.9"
    assert set(table.index.get_level_values("released from")) == {"unsettled", "quiet"}
    shares = table[[name for name in table if name.startswith("share ")]]
    assert shares.sum(axis=1).to_list() == pytest.approx([1] * len(table))


def test_each_policy_has_a_row(data):
    made = policies(data["migration"]["figure_15"], 1.7)
    table = migration.release_policies({"release_policies": {"paper": made}})
    rows = table.set_index("policy (K in cycles, phase ΩT in radian)")
    assert list(rows.index) == [
        "state in the goal's basin, at most K = 5",
        "fixed number of cycles, K = 5",
        "fixed phase 1.50 after K = 5",
    ]
    assert list(rows["share within 350 cycles (95 % interval)"])[0] == "0.1 (0.05 to 0.15)"
    assert set(rows["damper"]) == {"rm = 0.12, d0 = 2.08333, e = 1"}


def test_files(tmp_path):
    table = pd.DataFrame({"name": ["a|b", "c"], "number": [1 / 3, np.nan], "count": [10, 2000000]})
    csv, markdown = tmp_path / "new" / "table.csv", tmp_path / "new" / "table.md"
    save_table(table, csv, markdown)
    assert csv.read_bytes() == b"name,number,count\na|b,0.333333,10\nc,,2000000\n"
    assert markdown.read_text().splitlines()[2].split() == r"| a\|b | 0.3333 | 10 |".split()


def test_a_row_of_a_machine_states_what_to_build_and_what_it_promises():
    def row(**changed):
        made = {"made_up": made_up_design(**changed)}
        return machines({"machines": made}).to_dict("records")[0]

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
