"""Problems with how much a configuration asks for: no job may run without end, or out of memory.

Values that are each allowed can be too much together.
"""

import math

from impact_damper.system.bounds import CLEARANCE_RANGE, MOST_RUNS, MOST_STIFF
from impact_damper.system.parameters import Oscillator
from impact_damper.theory.design_rule import peak_frequency, rule_clearance
from impact_damper.workflow.contradictions import WITH_OSCILLATOR, cells_of, dotted, problem

# Cells that a study may have.
MOST_CELLS = 10**8
# What they are counted by, in the whole configuration and in the entries of a section.
COUNTS = (
    ("points.free", "search.starts"),
    ("points.simulated", "search.starts"),
    ("points.clearances", "search.sweep_starts"),
    ("points.scanned", "search.scan_starts"),
    ("points.scanned", "controller.releases"),
    ("points.map_frequencies", "points.map_values"),
)
ENTRY_COUNTS = {
    "design_rules": ("mass_ratios", "restitutions", "contact_stiffnesses", "frequencies"),
    "contact_model": ("cells.restitutions", "cells.loads"),
    "rigid_limit": ("cells.frequencies", "cells.stiffnesses"),
    "missed_contacts": ("passages", "depths.points", "tolerances.points"),
    "stable_steps": ("stiffnesses.points", "scaled_steps.points"),
}
# Largest radius of the ball of random starts over the clearance, as `motions.random_states` has it:
# in a smaller share of the ball hardly a draw is within the gap.
MOST_RADIUS = 1e3
# Radius of the ball from which migration draws.
MIGRATION_RADIUS = 2


def workloads(config):
    """Problems with the amount of work, in a configuration without contradictions."""
    for keys in COUNTS:
        yield from _too_many([], config, keys)
    for section, keys in ENTRY_COUNTS.items():
        for name, entry in config[section].items():
            yield from _too_many([section, name], entry, keys)
    for name, study in config["studies"].items():
        yield from _too_many_cells(["studies", name], cells_of(study), config["chunks"])
    for path, entry, slowest in _dampers(config):
        yield from _too_stiff(path, entry, slowest, config["contact_stiffness"])
    most = CLEARANCE_RANGE["most"]
    radius = max(config["search"]["radius"], MIGRATION_RADIUS)
    for path, key, clearance in _clearances(config):
        if clearance * MOST_RADIUS < radius:
            reason = f"must be at least search.radius/{MOST_RADIUS:g} = {radius / MOST_RADIUS:g} "
            yield problem([*path, key], clearance, f"{reason}(hardly a start is within the gap)")
        if clearance > most:
            reason = f"must be at most {most:g} (the clearance of the rule here)"
            yield problem([*path, key], clearance, reason)


def _at(place, key):
    """What stands at a key with dots; of a list its length."""
    for name in key.split("."):
        place = place[name]
    return len(place) if isinstance(place, list) else place


def _too_many(path, place, keys):
    counts = [_at(place, key) for key in keys]
    if math.prod(counts) > MOST_RUNS:
        largest = counts.index(max(counts))
        others = [f"{k} ({n})" for k, n in zip(keys, counts, strict=True) if k != keys[largest]]
        reason = (
            f"with {' and '.join(others)} makes {math.prod(counts)}: "
            f"must be at most {MOST_RUNS} in all (a job keeps them in memory)"
        )
        yield problem([*path, *keys[largest].split(".")], counts[largest], reason)


def _too_many_cells(path, cells, chunks):
    if cells > MOST_CELLS:
        reason = f"must be at most {MOST_CELLS} (combinations of the points of its four axes)"
        yield f"{dotted(path)}: cells = {cells}: {reason}"
    elif cells > chunks * MOST_RUNS:
        reason = f"must be at least {math.ceil(cells / MOST_RUNS)} with the {cells} cells of "
        reason += f"{dotted(path)} (a job keeps its results in memory, {MOST_RUNS} at most)"
        yield problem(["chunks"], chunks, reason)


def _dampers(config):
    """Entries that have a damper: path, entry and its lowest forcing frequency."""
    for section in WITH_OSCILLATOR:
        for name, entry in config[section].items():
            span = config["oscillators"][entry["oscillator"]]["frequencies"]
            if section == "studies":
                entry = {key: _least(value) for key, value in entry.items()}
            if "mass_ratio" in entry or "mass_ratios" in entry:
                yield [section, name], entry, _lowest(entry, span)
            for inner, scene in entry.get("damped", {}).items():
                yield [section, name, "damped", inner], scene, _lowest(scene, span)
    for name, entry in config["balance_map"].items():
        entry = entry | {entry["parameter"]: entry["values"]["first"]}
        damping = max(entry["damping"], entry["values"]["last"] * (entry["parameter"] == "damping"))
        peak = peak_frequency(Oscillator(damping, entry["linear_frequency"]))
        yield ["balance_map", name], entry, entry["frequency_ratios"]["first"] * peak


def _lowest(entry, span):
    """Lowest forcing frequency of an entry, or that of its oscillator."""
    given = entry.get("frequencies", entry.get("frequency", span))
    return min(given) if isinstance(given, list) else _least(given)


def _least(given):
    """What is given, or the least value of a range."""
    return given["first"] if isinstance(given, dict) else given


def _too_stiff(path, entry, slowest, common):
    mass_ratio = min(entry.get("mass_ratios", [entry.get("mass_ratio", math.inf)]))
    given = [
        entry.get("contact_stiffness", common),
        *entry.get("contact_stiffnesses", []),
        entry.get("stiffnesses", {}).get("last", 0),
    ]
    ratio = math.sqrt(max(given) * (1 + 1 / mass_ratio)) / slowest
    if ratio > MOST_STIFF:
        key = "mass_ratios" if "mass_ratios" in entry else "mass_ratio"
        reason = (
            f"with r1 = {max(given):g} and W = {slowest:g} must be so large that "
            f"sqrt(r1 (1 + 1/rm))/W = {ratio:g} is at most {MOST_STIFF:g} (steps of a contact)"
        )
        yield problem([*path, key], mass_ratio, reason)


def _clearances(config):
    """Least and greatest clearances of the entries: path, key and value."""
    for path, entry, _ in _dampers(config):
        if isinstance(entry.get("clearances"), dict):
            yield path, "clearances", entry["clearances"]["first"]
        elif entry.get("clearance") == "rule":
            yield from ((path, "clearance", value) for value in _by_rule(entry, config))
        elif "clearance" in entry:
            yield path, "clearance", entry["clearance"]


def _by_rule(entry, config):
    """Clearances of rule (19) for an entry, or for both ends of a map."""
    ends = [entry]
    if "values" in entry:
        ends = [entry | {entry["parameter"]: value} for value in entry["values"].values()]
    for end in ends:
        known = config["oscillators"].get(entry.get("oscillator"), {}) | end
        oscillator = Oscillator(known["damping"], known["linear_frequency"])
        yield rule_clearance(oscillator, known["mass_ratio"])
