"""Where single-term harmonic balance fails: its verdicts against the true motions, as a map.

In each cell two questions are asked. Quiet: is the solution of (7) with the smallest |a| a
stable motion, by the slow flow (17), and by the Floquet multipliers of the true orbit?
High: is there a stable solution as large as the free resonance, and where does a start there
lead? The balance knows elastic contact only: with e < 1 its verdict is that for e = 1.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.motions import ensemble
from impact_damper.motions.records import MOTION
from impact_damper.motions.simulate import check_settling
from impact_damper.orbits.quiet_orbits import is_symmetric_pair, quiet_orbits, straight_flight_end
from impact_damper.stages.harmonic_balance import optimum_clearance
from impact_damper.system import packed
from impact_damper.system.bounds import check_number
from impact_damper.system.checks import check_increasing
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.system.parameters import Damper, Oscillator, pick
from impact_damper.theory.design_rule import peak_frequency
from impact_damper.theory.map_cells import HIGH, balance_cells

PARAMETERS = ("damping", "mass_ratio", "clearance", "restitution")
# A settled motion is near what is foretold if it is within this share of it.
NEAR = 0.2
# So many chaotic high motions are run so many times as long as the patience.
CHECKED = 50
LONG = 10


class _Row(NamedTuple):
    """Systems of one row of a map, and the forcing frequencies of its cells."""

    oscillator: Oscillator
    damper: Damper
    frequencies: np.ndarray


def balance_map(
    parameter, values, frequency_ratios, fixed, *, settling=None, workers=1, progress=None
):
    """Verdicts of harmonic balance against true motions, over frequency and a parameter.

    Parameters
    ----------
    parameter : str
        What changes from row to row: damping (h), mass_ratio (rm), clearance (d0) or
        restitution (e).
    values : array_like, shape (n,)
        Its increasing values.
    frequency_ratios : array_like, shape (m,)
        Increasing forcing frequencies W/Wp, with the peak frequency Wp of the row.
    fixed : dict
        The other arguments of `Oscillator` and `Damper`. Without `clearance` it follows rule
        (19) in each row, as a designer would let it.
    settling : Settling, optional
    workers : int
        Threads; the result does not depend on it.
    progress : str, optional
        Title of a progress bar.

    Returns
    -------
    xarray.Dataset
        On (map_value, frequency_ratio) the verdict of the balance, the truth, and the class
        that both make, of the quiet motion and of the high one; on map_value the ends of the
        quiet orbits.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    settling = check_settling(settling)
    rows = _rows(parameter, values, frequency_ratios, fixed)
    parameters = np.array(
        [[pack(row.oscillator, row.damper, w) for w in row.frequencies] for row in rows]
    )
    said = balance_cells(rows)
    quiet_runs, high_runs = (
        _run(parameters, starts, settling, workers, progress)
        for starts in (said.quiet_start, said.high_start)
    )
    quiet_kind, high_kind = (_kinds(runs, said.resonance) for runs in (quiet_runs, high_runs))
    landed = quiet_kind == flag("quiet_run_motion", "quiet")
    orbits = quiet_orbits(parameters, np.where(landed[..., None], quiet_runs["state"], np.nan))
    data = {
        "map_frequency": parameters[..., FREQUENCY],
        "map_clearance": [row.damper.clearance for row in rows],
        "resonance_amplitude": said.resonance,
        "straight_flight_end": [_rigid_end(row) for row in rows],
        "high_long_outcome": _long(parameters, said.high_start, high_kind, settling, workers),
    }
    data |= _quiet_data(said, quiet_kind, quiet_runs)
    data |= _orbit_data(said, orbits, parameters[..., FREQUENCY], frequency_ratios)
    data |= _high_data(said, high_kind, high_runs)
    coordinates = {
        "map_value": np.asarray(values, float),
        "frequency_ratio": np.asarray(frequency_ratios, float),
        "edge": ["lower", "upper"],
    }
    made = fixed | {"parameter": parameter} | vars(settling)
    return dataset(data, coordinates, made, "Harmonic balance against the true motions")


def _quiet_data(said, kinds, runs):
    return {
        "balance_quiet": said.quiet,
        "balance_quiet_amplitude": said.quiet_amplitude,
        "balance_quiet_growth": said.quiet_growth,
        "quiet_run_motion": kinds,
        "quiet_run_exponent": runs["lyapunov_exponent"],
        "quiet_run_error": runs["lyapunov_error"],
    }


def _orbit_data(said, orbits, frequency, ratios):
    truth = _truth(orbits)
    return {
        "quiet_orbit": truth,
        "quiet_orbit_growth": np.log(np.abs(orbits.multiplier)) * frequency / np.pi,
        "quiet_orbit_displacement": orbits.displacement,
        "quiet_orbit_harmonic": orbits.harmonic,
        "quiet_verdict": _quiet_verdict(said.quiet, truth),
        "quiet_end": np.interp(orbits.end, np.arange(len(ratios)), ratios),
        "quiet_end_event": orbits.end_event,
    }


def _high_data(said, kinds, runs):
    return {
        "balance_high": said.high,
        "balance_high_amplitude": said.high_amplitude,
        "high_run_motion": kinds,
        "high_run_outcome": runs["outcome"],
        "high_run_period": runs["period"],
        "high_run_contacts": runs["contacts"],
        "high_run_displacement": runs["maximum_displacement"],
        "high_run_exponent": runs["lyapunov_exponent"],
        "high_run_error": runs["lyapunov_error"],
        "high_verdict": _high_verdict(said, kinds, runs["maximum_displacement"]),
    }


def _rows(parameter, values, ratios, fixed):
    if parameter not in PARAMETERS:
        raise ValueError(f"parameter = {parameter!r}: must be one of {', '.join(PARAMETERS)}")
    if parameter in fixed:
        raise ValueError(f"fixed: must not hold {parameter}, which changes from row to row")
    values = check_increasing("values", values, least="two")
    ratios = check_increasing("frequency_ratios", ratios, least="two")
    check_number("frequency_ratios", ratios[0], above=0.0, why="the forcing is periodic")
    rows = []
    for value in values:
        given = fixed | {parameter: float(value)}
        own = pick(Oscillator, given)
        oscillator = Oscillator(**own)
        given = {name: number for name, number in given.items() if name not in own}
        if "clearance" not in given:
            given["clearance"] = optimum_clearance(oscillator, given["mass_ratio"])
        rows.append(_Row(oscillator, Damper(**given), ratios * peak_frequency(oscillator)))
    return rows


def _run(parameters, starts, settling, workers, progress):
    """Records of the motions from the starts that there are, in their cells."""
    asked = np.isfinite(starts[..., 0])
    records = np.zeros(asked.shape, MOTION)
    records["outcome"] = flag("outcome", "absent")
    for name in ("maximum_displacement", "lyapunov_exponent", "lyapunov_error", "contacts"):
        records[name] = np.nan
    records[asked] = ensemble.settle(
        parameters[asked], starts[asked], settling, workers=workers, progress=progress
    )
    return records


def _long(parameters, starts, kinds, settling, workers):
    """What chaotic high motions, evenly spread over the map, come to in a longer run."""
    cells = np.flatnonzero(kinds == flag("high_run_motion", "high_chaotic"))
    outcome = np.full(kinds.size, flag("high_long_outcome", "absent"))
    if len(cells):
        chosen = np.unique(cells[np.linspace(0, len(cells) - 1, CHECKED).astype(int)])
        patience = LONG * settling.patience
        longer = replace(settling, patience=patience, limit=max(settling.limit, patience + 100))
        given = parameters.reshape(-1, packed.COUNT)[chosen], starts.reshape(-1, 4)[chosen]
        outcome[chosen] = ensemble.settle(*given, longer, workers=workers)["outcome"]
    return outcome.reshape(kinds.shape)


def _kinds(records, resonance):
    """Flag `quiet_run_motion` of each run."""
    low = records["maximum_displacement"] < HIGH * resonance
    quiet = low & is_symmetric_pair(records)
    outcome = records["outcome"]
    cases = {
        "not_run": outcome == flag("outcome", "absent"),
        "no_contact": outcome == flag("outcome", "non_colliding"),
        "quiet": is_settled(records) & quiet,
        "other_low": is_settled(records) & low,
        "high": is_settled(records),
        "low_chaotic": (outcome == flag("outcome", "chaotic")) & low,
        "high_chaotic": outcome == flag("outcome", "chaotic"),
    }
    kinds = [flag("quiet_run_motion", name) for name in cases]
    return np.select(list(cases.values()), kinds, flag("quiet_run_motion", "unresolved"))


def _truth(orbits):
    """Flag `quiet_orbit`: absent only beyond a place where the orbit was seen to end."""
    values = orbits.multiplier
    columns = np.arange(values.shape[1])
    ended = np.isin(
        orbits.end_event,
        [flag("quiet_end_event", name) for name in ("fold", "contacts_change")],
    )
    below = ended[:, :1] & (columns < orbits.end[:, :1])
    above = ended[:, 1:] & (columns > orbits.end[:, 1:])
    real = values.imag == 0
    cases = {
        "stable": np.abs(values) < 1,
        "neimark_sacker": np.isfinite(values) & ~real,
        "fold": real & (values.real > 0),
        "symmetry_breaking": real & (values.real < 0),
        "absent": below | above,
    }
    kinds = [flag("quiet_orbit", name) for name in cases]
    return np.select(list(cases.values()), kinds, flag("quiet_orbit", "unresolved"))


def _quiet_verdict(said, truth):
    """Flag `quiet_verdict`."""
    verdict = np.full(said.shape, flag("quiet_verdict", "unresolved"))
    cases = {
        "stable": truth == flag("quiet_orbit", "stable"),
        "unstable": truth > flag("quiet_orbit", "stable"),
        "absent": truth == flag("quiet_orbit", "absent"),
    }
    for name in ("stable", "unstable", "none"):
        for true, holds in cases.items():
            here = (said == flag("balance_quiet", name)) & holds
            verdict[here] = flag("quiet_verdict", f"{name}_{true}")
    return verdict


def _high_verdict(said, kinds, displacement):
    """Flag `high_verdict`."""
    near = np.abs(displacement / said.high_amplitude - 1) <= NEAR
    low = np.isin(
        kinds, [flag("high_run_motion", n) for n in ("quiet", "other_low", "low_chaotic")]
    )
    settled = kinds == flag("high_run_motion", "high")
    stable = said.high == flag("balance_high", "stable")
    none = said.high == flag("balance_high", "none")
    chaotic = kinds == flag("high_run_motion", "high_chaotic")
    silent = kinds == flag("high_run_motion", "no_contact")
    cases = {
        "stable_near": stable & settled & near,
        "stable_far": stable & settled,
        "stable_chaotic": stable & chaotic,
        "stable_low": stable & low,
        "stable_no_contact": stable & silent,
        "none_settled": none & settled,
        "none_chaotic": none & chaotic,
        "none_low": none & low,
        "none_no_contact": none & silent,
        "not_run": none & (kinds == flag("high_run_motion", "not_run")),
    }
    flags = [flag("high_verdict", name) for name in cases]
    return np.select(list(cases.values()), flags, flag("high_verdict", "unresolved"))


def _rigid_end(row):
    peak = peak_frequency(row.oscillator)
    return straight_flight_end(row.damper.clearance, row.damper.restitution) / peak
