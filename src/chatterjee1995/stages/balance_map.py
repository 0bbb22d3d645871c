"""Map of the errors of one-term harmonic balance, for quiet and for violent ("high") motions."""

from dataclasses import replace
from functools import lru_cache, partial
from typing import NamedTuple

import numpy as np

from chatterjee1995.methods.quiet_orbits import follow_quiet_orbits, straight_flight_end
from impact_damper.data.datasets import dataset, flag, is_settled, touches_no_wall
from impact_damper.data.variables import register
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator, pick
from impact_damper.motions import ensemble
from impact_damper.motions.records import MOTION, is_symmetric_pair
from impact_damper.theory.design_rule import peak_frequency, rule_clearance
from impact_damper.theory.free_oscillator import resonance
from impact_damper.theory.single_harmonic import (
    fixed_points,
    growth_rate,
    impacting_solutions,
    stability,
)

register(
    """
map_value | map_value | | | value of the parameter that differs between the rows of a map
frequency_ratio | frequency_ratio | | Omega/Omega_p | forcing frequency over the peak frequency
balance_quiet | map_value frequency_ratio | | | stability of the quiet solution of harmonic
  balance by the slow flow
  : none 0, stable 1, unstable 2, unresolved 3
balance_quiet_amplitude | map_value frequency_ratio | | |a| | |a| of the quiet solution of
  harmonic balance
quiet_orbit_displacement | map_value frequency_ratio | | max |Z1| | largest displacement in the
  quiet orbit
quiet_orbit_harmonic | map_value frequency_ratio | | | amplitude of the first harmonic of Z1 in
  the quiet orbit
quiet_verdict | map_value frequency_ratio | | | quiet motion: stability by harmonic balance, then
  stability of the exact orbit
  : unresolved 0, stable_stable 1, stable_unstable 2, stable_absent 3,
  : unstable_stable 4, unstable_unstable 5, unstable_absent 6, none_stable 7, none_unstable 8,
  : none_absent 9
quiet_end | map_value edge | | | Omega/Omega_p at the ends of the range of quiet orbits in a row
quiet_end_event | map_value edge | | | event that ends the range of quiet orbits in a row
  : map_ends 0, fold 1, contacts_change 2, not_converged 3, no_orbit 4
straight_flight_end | map_value | | | Omega/Omega_p at the upper end of quiet orbits, for rigid
  walls at high frequency
quiet_run_motion | map_value frequency_ratio | | | motion to which a start at the quiet solution
  of harmonic balance leads
  : not_run -1, unresolved 0, quiet 1, other_low 2, low_chaotic 3, high 4, high_chaotic 5,
  : no_contact 6
balance_high | map_value frequency_ratio | | | stability of the high solution of harmonic balance
  : balance_quiet
high_run_motion | map_value frequency_ratio | | | motion to which the high run leads; the run
  starts at the high solution of harmonic balance or, where none exists, on the free resonance
  branch
  : quiet_run_motion
high_run_outcome | map_value frequency_ratio | | | outcome of the high run
  : outcome
high_verdict | map_value frequency_ratio | | | high motion: result of harmonic balance, then
  motion to which the high run leads
  : not_run -1, unresolved 0, stable_near 1, stable_far 2, stable_chaotic 3, stable_low 4,
  : stable_no_contact 5, none_settled 6, none_chaotic 7, none_low 8, none_no_contact 9
    """
)

NEAR = 0.2  # a motion is near if max |Z1| differs from the prediction by at most this fraction
HIGH = 0.5  # a motion is low if max |Z1| is below this fraction of `Cells.resonance`, else high


class Cells(NamedTuple):
    """Solutions of harmonic balance in all cells of a map, and the states from which runs start.

    All starts are states at T = 0. `resonance` is the amplitude of the free resonance. Beyond
    the end of the resonance branch it is the amplitude at this end. Without a quiet solution,
    `quiet_amplitude` and `quiet_start` are NaN. Without a high solution, `high_amplitude` is NaN.
    Then `high_start` is on the free resonance with a loose mass at rest, or NaN beyond the branch.
    """

    resonance: np.ndarray
    quiet: np.ndarray
    quiet_amplitude: np.ndarray
    quiet_start: np.ndarray
    high: np.ndarray
    high_amplitude: np.ndarray
    high_start: np.ndarray


def balance_cells(rows) -> Cells:
    """Solve the harmonic balance (7) in all cells of a map.

    Each of `rows` holds an oscillator, a damper and a list of frequencies, one for each cell. The
    quiet solution is the smallest one, if its |a| is below HIGH * `Cells.resonance`. The high
    solution is the largest stable one, if its |a| is not below this limit.
    """
    cells = [
        [_cell(oscillator, damper, frequency) for frequency in frequencies]
        for oscillator, damper, frequencies in rows
    ]
    return Cells(
        *(np.array([[cell[k] for cell in row] for row in cells]) for k in range(len(Cells._fields)))
    )


def _cell(oscillator, damper, frequency):
    free, phase = _resonance(oscillator, frequency)
    high_start = np.full(4, np.nan)
    if phase is not None:
        start = _start(free, 0.0, phase, frequency)
        high_start = np.array([start[0], start[1], 0.0, start[1]])
    nothing = np.nan, np.full(4, np.nan)
    elastic = replace(damper, restitution=1.0)
    try:
        solutions, growth = _solutions(oscillator, elastic, frequency)
    except ArithmeticError:
        unresolved = flag("balance_quiet", "unresolved")
        return Cells(free, unresolved, *nothing, unresolved, np.nan, high_start)
    signs = stability(growth)
    amplitude = np.abs(solutions.amplitude)

    def start_at(k):
        return _start(*(values[k] for values in solutions), frequency)

    quiet = flag("balance_quiet", "none"), *nothing
    if len(amplitude) and np.min(amplitude) < HIGH * free:
        k = np.argmin(amplitude)
        verdict = {1: "stable", -1: "unstable", 0: "unresolved"}[int(signs[k])]
        quiet = flag("balance_quiet", verdict), amplitude[k], start_at(k)
    high = flag("balance_high", "none"), np.nan, high_start
    large = np.flatnonzero((signs == flag("stability", "stable")) & (amplitude >= HIGH * free))
    if len(large):
        k = large[np.argmax(amplitude[large])]
        high = flag("balance_high", "stable"), amplitude[k], start_at(k)
    return Cells(free, *quiet, *high)


@lru_cache(4096)
def _solutions(oscillator, damper, frequency):
    solutions = impacting_solutions(oscillator, damper, frequency)
    return solutions, growth_rate(fixed_points(solutions), oscillator, damper, frequency)


_resonance = lru_cache(4096)(resonance)


def _start(amplitude, relative_amplitude, phase, frequency):
    turn = np.array([np.cos(phase), -frequency * np.sin(phase)])
    return np.concatenate([amplitude * turn, relative_amplitude * turn])


class _Row(NamedTuple):
    oscillator: Oscillator
    damper: Damper
    frequencies: np.ndarray


def balance_map(parameter, values, frequency_ratios, fixed, *, settling, workers=1, progress=None):
    """Return a dataset that compares harmonic balance with exact motions, on a grid.

    A row of the grid has one of the `values` of the parameter. A column has one of the
    `frequency_ratios`, which are frequencies divided by the peak frequency. `fixed` holds the other
    parameters. If `fixed` contains no clearance, rule (19) sets one for each row.
    """
    rows = _rows(parameter, values, frequency_ratios, fixed)
    parameters = np.array(
        [[pack(row.oscillator, row.damper, w) for w in row.frequencies] for row in rows]
    )
    balance = balance_cells(rows)
    quiet_runs, high_runs = (
        _run(parameters, starts, settling, workers, progress)
        for starts in (balance.quiet_start, balance.high_start)
    )
    quiet_kind, high_kind = (_kinds(runs, balance.resonance) for runs in (quiet_runs, high_runs))
    landed = quiet_kind == flag("quiet_run_motion", "quiet")
    known = np.where(landed[..., None], quiet_runs["state"], np.nan)
    orbits = follow_quiet_orbits(parameters, known)
    data = {
        "straight_flight_end": [
            straight_flight_end(row.oscillator, row.damper.clearance, row.damper.restitution)
            / peak_frequency(row.oscillator)
            for row in rows
        ],
        "balance_quiet": balance.quiet,
        "balance_quiet_amplitude": balance.quiet_amplitude,
        "quiet_run_motion": quiet_kind,
        "quiet_orbit_displacement": orbits.displacement,
        "quiet_orbit_harmonic": orbits.harmonic,
        "quiet_verdict": _quiet_verdict(balance.quiet, orbits),
        "quiet_end": np.interp(orbits.end, np.arange(len(frequency_ratios)), frequency_ratios),
        "quiet_end_event": np.vectorize(partial(flag, "quiet_end_event"))(orbits.end_event),
        "balance_high": balance.high,
        "high_run_motion": high_kind,
        "high_run_outcome": high_runs["outcome"],
        "high_verdict": _high_verdict(balance, high_kind, high_runs["maximum_displacement"]),
    }
    coordinates = {"map_value": np.asarray(values, float)}
    coordinates |= {"frequency_ratio": np.asarray(frequency_ratios, float)}
    coordinates |= {"edge": ["lower", "upper"]}
    made = fixed | {"parameter": parameter} | vars(settling)
    return dataset(data, coordinates, made, "Harmonic balance against the true motions")


def _rows(parameter, values, ratios, fixed):
    rows = []
    for value in values:
        given = fixed | {parameter: float(value)}
        own = pick(Oscillator, given)
        oscillator = Oscillator(**own)
        given = {name: number for name, number in given.items() if name not in own}
        if "clearance" not in given:
            given["clearance"] = rule_clearance(oscillator, given["mass_ratio"])
        rows.append(
            _Row(oscillator, Damper(**given), np.asarray(ratios) * peak_frequency(oscillator))
        )
    return rows


def _run(parameters, starts, settling, workers, progress):
    asked = np.isfinite(starts[..., 0])
    records = np.zeros(asked.shape, MOTION)
    records["outcome"] = flag("outcome", "absent")
    for name in ("maximum_displacement", "lyapunov_exponent", "lyapunov_error", "contacts"):
        records[name] = np.nan
    records[asked] = ensemble.settle(
        parameters[asked], starts[asked], settling, workers=workers, progress=progress
    )
    return records


def _kinds(records, resonance):
    low = records["maximum_displacement"] < HIGH * resonance
    quiet = low & is_symmetric_pair(records)
    outcome = records["outcome"]
    regular = is_settled(records) | (outcome == flag("outcome", "quasi_periodic"))
    cases = {
        "not_run": outcome == flag("outcome", "absent"),
        "no_contact": touches_no_wall(records),
        "quiet": is_settled(records) & quiet,
        "other_low": regular & low,
        "high": regular,
        "low_chaotic": (outcome == flag("outcome", "chaotic")) & low,
        "high_chaotic": outcome == flag("outcome", "chaotic"),
    }
    kinds = [flag("quiet_run_motion", name) for name in cases]
    return np.select(list(cases.values()), kinds, flag("quiet_run_motion", "unresolved"))


def _quiet_verdict(balance, orbits):
    size = np.abs(orbits.multiplier)
    columns = np.arange(size.shape[1])
    ended = np.isin(orbits.end_event, ["fold", "contacts_change"])
    below = ended[:, :1] & (columns < orbits.end[:, :1])
    above = ended[:, 1:] & (columns > orbits.end[:, 1:])
    cases = {"stable": size < 1, "unstable": size >= 1, "absent": np.isnan(size) & (below | above)}
    verdict = np.full(balance.shape, flag("quiet_verdict", "unresolved"))
    for name in ("stable", "unstable", "none"):
        for true, holds in cases.items():
            here = (balance == flag("balance_quiet", name)) & holds
            verdict[here] = flag("quiet_verdict", f"{name}_{true}")
    return verdict


def _high_verdict(balance, kinds, displacement):
    near = np.abs(displacement / balance.high_amplitude - 1) <= NEAR
    low = np.isin(
        kinds, [flag("high_run_motion", n) for n in ("quiet", "other_low", "low_chaotic")]
    )
    settled = kinds == flag("high_run_motion", "high")
    stable = balance.high == flag("balance_high", "stable")
    none = balance.high == flag("balance_high", "none")
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
