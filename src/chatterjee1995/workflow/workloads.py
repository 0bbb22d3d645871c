"""Check of the amount of work, so that no job runs without end or out of memory.

Values that are allowed individually can be too large in combination.
"""

import math
from typing import NamedTuple

from chatterjee1995.workflow.models.balance import BalanceMap
from chatterjee1995.workflow.models.studies import Study
from chatterjee1995.workflow.models.system import OSCILLATOR, Range
from impact_damper.command.messages import dotted, problem
from impact_damper.command.section import parts
from impact_damper.model.bounds import CLEARANCE_RANGE, MOST_RADIUS, MOST_RUNS, MOST_STIFF
from impact_damper.model.parameters import Oscillator
from impact_damper.theory.design_rule import peak_frequency, rule_clearance

# Largest number of cells of a study.
MOST_CELLS = 10**8
# Keys of the whole configuration whose product is the number of runs of a job. The attribute
# `counts` of a model lists such keys within one entry.
COUNTS = (
    ("points.free", "search.starts"),
    ("points.simulated", "search.starts"),
    ("points.clearances", "search.sweep_starts"),
    ("points.scanned", "search.scan_starts"),
    ("points.scanned", "controller.releases"),
    ("points.map_frequencies", "points.map_values"),
)
# Forcing frequency assumed for a section without an oscillator. Frequencies of such a section are
# ratios to the natural frequency.
NATURAL = 1.0
# Radius of the ball from which the stages on migration (a change of the motion by switching the
# damper) draw random initial states.
MIGRATION_RADIUS = 2


class Case(NamedTuple):
    """Entry with a damper: its path, and values that determine the amount of work.

    Attributes
    ----------
    path : tuple of str
        Keys that lead to the entry in the configuration.
    key : str
        Key of the mass ratio in the entry.
    mass_ratio, stiffness, frequency : float
        Smallest mass ratio, largest contact stiffness and lowest forcing frequency of the entry.
    clearances : list of (str, float)
        Keys with their smallest clearances.
    """

    path: tuple
    key: str
    mass_ratio: float
    stiffness: float
    frequency: float
    clearances: list


def workloads(config):
    """Yield a line for each problem with the amount of work, in a valid configuration."""
    for keys in COUNTS:
        yield from _too_many((), config, keys)
    for path, section in parts(config):
        yield from _too_many(path, section, getattr(section, "counts", ()))
        if isinstance(section, Study):
            yield from _too_many_cells(path, section.cells(), config.chunks)
    radius = max(config.search.radius, MIGRATION_RADIUS)
    for path, section in parts(config):
        try:
            case = _case(path, section, config)
        except ValueError as error:
            # The rule for the clearance and the peak frequency are not defined for all oscillators.
            reason = "no clearance by `rule`, or no peak, with this oscillator"
            yield f"{dotted(path)}: {reason}: {error}"
            continue
        if case is None:
            continue
        yield from _too_stiff(case)
        for key, clearance in case.clearances:
            yield from _too_narrow_or_wide((*case.path, key), clearance, radius)


def _at(section, key):
    """Return the number under a dotted key of a section, or the length of the list there."""
    for name in key.split("."):
        section = getattr(section, name)
    return len(section) if isinstance(section, list) else section


def _too_many(path, section, keys):
    """Yield a line if the product of the counts under some keys exceeds the limit of runs."""
    counts = [_at(section, key) for key in keys]
    if math.prod(counts) > MOST_RUNS:
        largest = counts.index(max(counts))
        others = [f"{k} ({n})" for k, n in zip(keys, counts, strict=True) if k != keys[largest]]
        reason = (
            f"with {' and '.join(others)} makes {math.prod(counts)}: "
            f"must be at most {MOST_RUNS} in all (a job keeps them in memory)"
        )
        yield problem((*path, *keys[largest].split(".")), counts[largest], reason)


def _too_many_cells(path, cells, chunks):
    """Yield a line if a study has too many cells, in all or in each of its chunks."""
    if cells > MOST_CELLS:
        reason = f"must be at most {MOST_CELLS} (combinations of the points of its four axes)"
        yield f"{dotted(path)}: cells = {cells}: {reason}"
    elif cells > chunks * MOST_RUNS:
        reason = f"must be at least {math.ceil(cells / MOST_RUNS)} with the {cells} cells of "
        reason += f"{dotted(path)} (a job keeps its results in memory, {MOST_RUNS} at most)"
        yield problem(("chunks",), chunks, reason)


def _too_stiff(case):
    """Yield a line if a contact is so much faster than the forcing that steps become too many."""
    ratio = math.sqrt(case.stiffness * (1 + 1 / case.mass_ratio)) / case.frequency
    if ratio > MOST_STIFF:
        reason = (
            f"with r1 = {case.stiffness:g} and W = {case.frequency:g} must be so large that "
            f"sqrt(r1 (1 + 1/rm))/W = {ratio:g} is at most {MOST_STIFF:g} (steps of a contact)"
        )
        yield problem((*case.path, case.key), case.mass_ratio, reason)


def _too_narrow_or_wide(path, clearance, radius):
    """Yield a line if hardly any start lies within the gap, or if the clearance is too large.

    A start is a random initial state; a clearance may follow from the paper's rule (19).
    """
    least, most = radius / MOST_RADIUS, CLEARANCE_RANGE["most"]
    if clearance < least:
        reason = f"must be at least search.radius/{MOST_RADIUS:g} = {least:g}"
        yield problem(path, clearance, f"{reason} (hardly any start is within the gap)")
    if clearance > most:
        yield problem(path, clearance, f"must be at most {most:g} (`rule` gives this clearance)")


def _case(path, section, config):
    """Return the `Case` of an entry of the configuration, None without a damper.

    Raises
    ------
    ValueError
        If the oscillator has no peak, which the rule for the clearance needs.
    """
    key, mass_ratio = _given(section, "mass_ratios", "mass_ratio")
    if isinstance(section, BalanceMap):
        return _case_of_map(path, section, config)
    if mass_ratio is None:
        return None
    _, stiffness = _given(section, "stiffnesses", "contact_stiffnesses", "contact_stiffness")
    _, frequency = _given(section, "frequencies", "frequency")
    if frequency is None:
        named = getattr(section, "oscillator", None)
        frequency = config.oscillators[named].frequencies if named else NATURAL
    return Case(
        path,
        key,
        _least(mass_ratio),
        _greatest(stiffness or config.contact_stiffness),
        _least(frequency),
        _clearances(section, config),
    )


def _clearances(section, config):
    """Return the key and the smallest clearance of an entry in a list; [] without a clearance."""
    key, clearance = _given(section, "clearances", "clearance")
    if clearance == "rule":
        oscillator = config.oscillators[section.oscillator].built()
        clearance = rule_clearance(oscillator, section.mass_ratio)
    return [] if clearance is None else [(key, _least(clearance))]


def _case_of_map(path, section, config):
    """Return the `Case` of a map of harmonic balance, from its first and last row."""
    clearances, peaks, mass_ratios = [], [], []
    for row in section.ends():
        oscillator = Oscillator(**{key: row[key] for key in OSCILLATOR if key in row})
        peaks.append(peak_frequency(oscillator))
        mass_ratios.append(row["mass_ratio"])
        clearance = row["clearance"]
        if clearance == "rule":
            clearance = rule_clearance(oscillator, row["mass_ratio"])
        clearances.append(("clearance", clearance))
    frequency = section.frequency_ratios.first * min(peaks)
    stiffness = config.contact_stiffness
    return Case(path, "mass_ratio", min(mass_ratios), stiffness, frequency, clearances)


def _given(section, *keys):
    """Return the first of some keys with a value in a section, and the value; or None, None."""
    found = ((key, getattr(section, key, None)) for key in keys)
    return next(((key, value) for key, value in found if value is not None), (None, None))


def _least(value):
    """Return the smallest value of a number, a list or a range."""
    if isinstance(value, Range):
        return value.first
    return min(value) if isinstance(value, list) else value


def _greatest(value):
    """Return the largest value of a number, a list or a range."""
    if isinstance(value, Range):
        return value.last
    return max(value) if isinstance(value, list) else value
