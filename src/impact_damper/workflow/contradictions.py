"""Problems between values of the configuration that are each allowed by themselves."""

import itertools
import math
import reprlib

from impact_damper.data.variables.studies import AXES
from impact_damper.workflow.registry import KINDS, section_of

# Section in which a figure's data are found, by the figure's kind.
SECTIONS = {kind: section_of(kind) for kind in KINDS if section_of(kind)}

# What a figure of the kind `schematic` may name instead.
SCHEMATICS = ("elastic_model", "inelastic_model", "migration_scheme", "algorithm", "impact_pair")

# Sections whose entries name an oscillator.
WITH_OSCILLATOR = (
    "curves",
    "motion",
    "collisions",
    "optimum",
    "migration",
    "release_scan",
    "harmonic_convergence",
    "design_rules",
    "contact_model",
    "rigid_limit",
    "missed_contacts",
    "stable_steps",
    "method_verdicts",
    "scenes",
    "studies",
)

# Ranges of the entries of a section, that ascend.
RANGES = {
    "oscillators": ("frequencies",),
    "optimum": ("clearances",),
    "release_scan": ("frequencies",),
    "rigid_limit": ("frequencies", "stiffnesses"),
    "missed_contacts": ("depths", "tolerances", "steps"),
    "stable_steps": ("stiffnesses", "scaled_steps"),
    "method_verdicts": ("tolerances", "steps"),
}

# Most entries that a figure draws.
MOST_DRAWN = {kind.name: kind.most for kind in KINDS.values()}

# What may change over a map, and its bounds.
MAPPED = {
    "damping": (1e-9, 10),
    "mass_ratio": (1e-6, 10),
    "clearance": (1e-6, 1000),
    "restitution": (0.05, 1),
}


def contradictions(config):
    """Problems between values that are each allowed."""
    for section in WITH_OSCILLATOR:
        for name, entry in config[section].items():
            yield from _unknown(
                [section, name, "oscillator"], entry["oscillator"], config["oscillators"]
            )
    settling = config["settling"]
    if settling["limit"] < settling["patience"]:
        reason = f"must be at least settling.patience = {settling['patience']} (it comes later)"
        yield problem(["settling", "limit"], settling["limit"], reason)
    served = settling["scene"]
    yield from _unknown(["settling", "scene"], served, config["scenes"])
    if "tolerance" not in config["scenes"].get(served, {"tolerance": None}):
        path = ["scenes", served, "tolerance"]
        yield f"{dotted(path)}: missing; needed since settling.scene names it"
    for name, scene in config["scenes"].items():
        yield from _wrong_scene(["scenes", name], scene, config["comparison"]["batch"])
    yield from _wrong_comparison(["comparison"], config["comparison"])
    for name, model in config["contact_model"].items():
        if model["smallest_restitution"] == 1:
            reason = "must be less than 1 (where the map ends)"
            yield problem(["contact_model", name, "smallest_restitution"], 1, reason)
        for key in ("restitutions", "frequencies"):
            yield from _not_increasing(["contact_model", name, key], model[key])
    for name, grid in config["design_rules"].items():
        yield from _wrong_grid(["design_rules", name], grid, config["oscillators"])
    for section, ranges in RANGES.items():
        for name, entry in config[section].items():
            for key in ranges:
                yield from _reversed([section, name, key], entry[key])
    for name, entry in config["missed_contacts"].items():
        if entry["implicit_passages"] > entry["passages"]:
            reason = f"must be at most passages = {entry['passages']} (it is some of them)"
            path = ["missed_contacts", name, "implicit_passages"]
            yield problem(path, entry["implicit_passages"], reason)
        yield from _close_steps(["missed_contacts", name, "steps"], entry)
    for name, entry in config["method_verdicts"].items():
        yield from _close_steps(["method_verdicts", name, "steps"], entry)
        yield from _wrong_verdicts(["method_verdicts", name], entry)
    for name, study in config["studies"].items():
        yield from _wrong_study(["studies", name], study, config["chunks"])
    for name, entry in config["balance_map"].items():
        yield from _wrong_map(["balance_map", name], entry)
    for name, curve in config["curves"].items():
        yield from _wrong_stages(["curves", name], curve, config["search"]["starts"])
    for name, scene in config["harmonic_convergence"].items():
        keys = ("mass_ratio", "clearance", "restitution", "contact_stiffness")
        yield from _part_of_damper(["harmonic_convergence", name], scene, keys)
    for name, figure in config["figures"].items():
        yield from _wrong_data(["figures", name, "data"], figure, config)


def _unknown(path, value, known):
    if value not in known:
        yield problem(path, value, f"must be one of {', '.join(known)}")


def _reversed(path, span):
    if span["first"] >= span["last"]:
        reason = f"must be less than last = {span['last']!r} (a range ascends)"
        yield problem([*path, "first"], span["first"], reason)


def _not_increasing(path, values):
    if sorted(set(values)) != values:
        yield problem(path, values, "must increase (each is looked at once, in order)")


def _wrong_grid(path, grid, oscillators):
    for key in ("mass_ratios", "restitutions", "contact_stiffnesses", "frequencies"):
        if any(first >= second for first, second in itertools.pairwise(grid[key])):
            yield problem([*path, key], grid[key], "must increase (a grid ascends)")
    linear = oscillators.get(grid["oscillator"], {}).get("linear_frequency", 0)
    if grid["frequencies"][0] <= linear:
        reason = f"must lie above the linear frequency {linear!r} (the rules hold above it)"
        yield problem([*path, "frequencies"], grid["frequencies"], reason)


def _wrong_stages(path, curve, starts):
    if "subharmonic" in curve["stages"] and starts < 2:
        reason = f"must be at least 2 with {dotted(path)}.stages subharmonic (half are switched on)"
        yield problem(["search", "starts"], starts, reason)
    if "branches" in curve["stages"] and "response" not in curve["stages"]:
        reason = "must hold response with branches (orbits are followed from the motions found)"
        yield problem([*path, "stages"], curve["stages"], reason)
    yield from _part_of_damper(path, curve, ("mass_ratio", "clearance", "restitution"))
    damped = sorted({"design_orbit", "subharmonic"} & set(curve["stages"]))
    if damped and "mass_ratio" not in curve:
        reason = f"must not hold {damped[0]} without mass_ratio (there is no damper)"
        yield problem([*path, "stages"], curve["stages"], reason)
    if "harmonic_balance" in curve["stages"] and curve.get("restitution", 1) != 1:
        reason = "must be 1 with the stage harmonic_balance (it knows elastic contact only)"
        yield problem([*path, "restitution"], curve["restitution"], reason)
    if curve.get("clearance") == "rule" and set(curve["stages"]) - {
        "harmonic_balance",
        "design_orbit",
    }:
        reason = "must be a number with stages beside harmonic_balance and design_orbit"
        yield problem([*path, "clearance"], curve["clearance"], reason)


def _part_of_damper(path, scene, keys):
    given = [key for key in keys if key in scene]
    if given:
        for key in sorted(set(keys) - set(given)):
            words = f"needed with {', '.join(given)} (a damper is whole or absent)"
            yield f"{dotted([*path, key])}: missing; {words}"


def _close_steps(path, entry):
    span, points = entry["steps"], entry["tolerances"]["points"]
    ratio = span["last"] / span["first"]
    counts = {round(span["first"] * ratio ** (k / (points - 1))) for k in range(points)}
    if len(counts) < points:
        reason = f"must be so far from first = {span['first']} that {points} whole numbers fit"
        yield problem([*path, "last"], span["last"], f"{reason} (as many as tolerances.points)")


def _wrong_verdicts(path, entry):
    if not entry["damped"] and not entry["free"]:
        yield problem([*path, "damped"], {}, "must have an entry, here or in free (scenes to run)")
    for name in sorted(entry["damped"].keys() & entry["free"].keys()):
        reason = "must have another name (a damped scene is called the same)"
        yield problem([*path, "free", name], entry["free"][name], reason)


def _wrong_comparison(path, given):
    for key in ("taylor", "merson", "scipy"):
        if sorted(set(given[key]), reverse=True) != given[key]:
            reason = "must decrease (each is run once, the loosest first)"
            yield problem([*path, key], given[key], reason)
    if given["scipy_periods"] < 2 * given["batch"]:
        reason = f"must be at least twice batch = {given['batch']} (errors need two batches)"
        yield problem([*path, "scipy_periods"], given["scipy_periods"], reason)


def _wrong_scene(path, scene, batch):
    yield from _part_of_damper(path, scene, ("mass_ratio", "clearance", "restitution"))
    chaotic, quantity = scene["motion"] == "chaotic", scene["accuracy"]["quantity"]
    if chaotic and not {"mass_ratio", "clearance", "restitution"} & scene.keys():
        yield problem([*path, "motion"], "chaotic", "must have a damper (a free one is not)")
    if chaotic and scene["periods"] < 2 * batch:
        reason = f"must be at least twice comparison.batch = {batch} (errors need two batches)"
        yield problem([*path, "periods"], scene["periods"], reason)
    if chaotic != (quantity in ("contact_rate", "displacement", "exponent")):
        reason = f"must be another one (a {scene['motion']} motion is asked)"
        yield problem([*path, "accuracy", "quantity"], quantity, reason)


def _wrong_study(path, study, chunks):
    for key in AXES:
        if isinstance(study[key], dict):
            yield from _reversed([*path, key], study[key])
    cells = cells_of(study)
    if cells < chunks:
        reason = f"must be at most {cells} (the cells of {dotted(path)})"
        yield problem(["chunks"], chunks, reason)


def cells_of(study):
    """Combinations of the points of a study's axes."""
    return math.prod(_points(study[key]) for key in AXES)


def _points(axis):
    """Points of an axis, which is a number or a range."""
    return axis["points"] if isinstance(axis, dict) else 1


def _wrong_map(path, entry):
    yield from _reversed([*path, "frequency_ratios"], entry["frequency_ratios"])
    yield from _reversed([*path, "values"], entry["values"])
    changing = entry["parameter"]
    least, most = MAPPED[changing]
    for end, value in entry["values"].items():
        if not least <= value <= most:
            reason = f"must be from {least} to {most} (bounds of {changing})"
            yield problem([*path, "values", end], value, reason)
    for name in MAPPED:
        if name == changing and name in entry:
            reason = "must be left out (it changes from row to row)"
            yield problem([*path, name], entry[name], reason)
        elif name != changing and name not in entry:
            yield f"{dotted([*path, name])}: missing; needed where {changing} changes"


def _wrong_data(path, figure, config):
    kind = figure["kind"]
    known = SCHEMATICS if kind == "schematic" else config[SECTIONS[kind]]
    most = MOST_DRAWN.get(kind, len(figure["data"]))
    if len(figure["data"]) > most:
        reason = f"must be {most} at most (what a figure of the kind {kind} draws)"
        yield problem(path, figure["data"], reason)
    for place, name in enumerate(figure["data"]):
        yield from _unknown([*path, place], name, known)
        if known is config["curves"] and name in known:
            yield from _wrong_curve(["curves", name], known[name], kind, path)
        elif kind == "studies" and name in known:
            yield from _not_drawable(["studies", name], known[name], path)


def _wrong_curve(path, curve, kind, figure):
    stage, figure = KINDS[kind].stages[0], ".".join(figure[:2])
    if stage not in curve["stages"]:
        reason = f"must hold {stage} (what {figure} draws)"
        yield problem([*path, "stages"], curve["stages"], reason)
    if KINDS[kind].damper != ("mass_ratio" in curve):
        reason = "with" if KINDS[kind].damper else "without"
        yield f"{figure}.data: {path[1]} must be a curve {reason} a damper (kind {kind})"


def _not_drawable(path, study, figure):
    for key in ("mass_ratio", "clearance"):
        if not isinstance(study[key], dict):
            reason = f"must be a range (an axis of the map of {'.'.join(figure[:2])})"
            yield problem([*path, key], study[key], reason)
    for key in ("frequency", "restitution"):
        if _points(study[key]) > 3:
            reason = f"must be at most 3 (panels of {'.'.join(figure[:2])} side by side)"
            yield problem([*path, key, "points"], study[key]["points"], reason)


def problem(path, value, reason):
    """One line on a value: its key, what it is, and what it must be."""
    return f"{dotted(path)} = {reprlib.repr(value)}: {reason}"


def dotted(path):
    """A path of keys as one key with dots, in one line."""
    return ".".join(map(_word, path)) or "configuration"


def _word(key):
    """A key as it stands, or quoted if it would break the line."""
    plain = isinstance(key, str) and key.isprintable() and len(key) <= 80
    return key if plain else reprlib.repr(key)
