"""Validation of the workflow's configuration: every problem in one line, before any job starts."""

import itertools
import math
import numbers
import re
import reprlib

import jsonschema
import yaml

# Section in which a figure's data are found, by the figure's kind.
SECTIONS = {
    "free": "oscillators",
    "design": "curves",
    "response": "curves",
    "branches": "curves",
    "motion": "motions",
    "optimum": "optima",
    "migration": "migration",
    "release": "migration",
    "contact_model": "contact_model",
    "rigid_limit": "rigid_limit",
    "design_rules": "design_rules",
    "harmonics": "harmonics",
    "missed_contacts": "missed_contacts",
    "stable_steps": "stable_steps",
    "verdicts": "verdicts",
    "balance_map": "balance_map",
}

# What may change over a map, and its bounds.
MAPPED = {
    "damping": (0, 10),
    "mass_ratio": (0, 10),
    "clearance": (0, 1000),
    "restitution": (0.05, 1),
}

# Sections whose entries name an oscillator.
WITH_OSCILLATOR = (
    "curves",
    "motions",
    "collisions",
    "optima",
    "migration",
    "release_scans",
    "contact_model",
    "rigid_limit",
)

# What a figure of the kind `schematic` may name instead.
SCHEMATICS = ("elastic_model", "inelastic_model", "migration_scheme", "algorithm", "impact_pair")

# Sections whose entries name an oscillator.
REFERRING = (
    "curves",
    "motions",
    "collisions",
    "optima",
    "migration",
    "release_scans",
    "missed_contacts",
    "stable_steps",
    "verdicts",
)
# Ranges of the entries of a section, that ascend.
RANGES = {
    "oscillators": ("frequencies",),
    "optima": ("clearances",),
    "release_scans": ("frequencies",),
    "missed_contacts": ("depths", "tolerances", "steps"),
    "stable_steps": ("stiffnesses", "scaled_steps"),
    "verdicts": ("tolerances", "steps"),
}

TYPES = {
    "object": "keys with values",
    "array": "a list",
    "string": "text",
    "number": "a finite number",
    "integer": "a whole number",
}

BOUNDS = {
    "exclusiveMinimum": "greater than {}",
    "minimum": "at least {}",
    "maximum": "at most {}",
    "pattern": "of the form {}",
    "minProperties": "with {} or more entries",
    "minItems": "with {} or more entries",
    "maxItems": "with {} entries at most",
    "uniqueItems": "without repetition",
    "minLength": "with {} or more characters",
}


class ConfigurationError(ValueError):
    """A configuration that cannot be run; the message has a line for each problem."""


def check_configuration(config, schema) -> None:
    """Raise if the configuration breaks the schema or contradicts itself.

    Parameters
    ----------
    config : dict
        The merged configuration.
    schema : dict
        JSON schema, whose descriptions say what a key means.

    Raises
    ------
    ConfigurationError
        Naming the key, the value, what is allowed and why, a line for each problem.
    """
    validator = _Validator(schema)
    # Paths may mix names and list positions, which have no order among themselves.
    errors = sorted(validator.iter_errors(config), key=lambda error: list(map(str, error.path)))
    problems = [line for error in errors for line in _lines(error)]
    # Contradictions are looked for only where every value is of its kind.
    problems = problems or list(_contradictions(config))
    if problems:
        raise ConfigurationError("\n".join(dict.fromkeys(problems)))


def without_left_out(config) -> dict:
    """The configuration without entries set to null: how a second file leaves out what a first has.

    Figures that draw such an entry go with it; one that is left with nothing to draw does too.
    """
    kept = {
        key: {name: entry for name, entry in value.items() if entry is not None}
        if isinstance(value, dict)
        else value
        for key, value in config.items()
    }
    for name, figure in list(kept.get("figures", {}).items()):
        section = SECTIONS.get(figure.get("kind")) if isinstance(figure, dict) else None
        entries = config.get(section)
        if not isinstance(entries, dict) or not isinstance(figure.get("data"), list):
            continue
        left_out = {key for key, entry in entries.items() if entry is None}
        data = [key for key in figure["data"] if key not in left_out]
        if data:
            kept["figures"][name] = figure | {"data": data}
        else:
            del kept["figures"][name]
    return kept


def check_unique_keys(text, name) -> None:
    """Raise if a key of a YAML file stands twice, of which a reader would keep the last alone.

    Raises
    ------
    ConfigurationError
        Naming the key and its line, a line for each problem.
    """
    problems = []
    nodes = [yaml.compose(text, Loader=yaml.SafeLoader)]
    while nodes:
        node = nodes.pop()
        if isinstance(node, yaml.MappingNode):
            seen = set()
            for key, value in node.value:
                if key.value in seen:
                    line = key.start_mark.line + 1
                    problems.append(f"{name}, line {line}: {key.value} stands twice: keep one")
                seen.add(key.value)
                nodes.append(value)
        elif isinstance(node, yaml.SequenceNode):
            nodes.extend(node.value)
    if problems:
        raise ConfigurationError("\n".join(problems))


def _is_integer(_, value):
    return isinstance(value, numbers.Integral) and not isinstance(value, bool)


def _is_number(_, value):
    return _is_integer(_, value) or isinstance(value, float) and math.isfinite(value)


def _pattern(_, pattern, value, __):
    if isinstance(value, str) and not re.fullmatch(pattern, value):
        yield jsonschema.ValidationError("no match")


# Stricter than JSON schema, for which 3.0 is an integer, NaN passes every bound, and a pattern
# need not match to the end.
_Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    {"pattern": _pattern},
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine_many(
        {"integer": _is_integer, "number": _is_number}
    ),
)


def _lines(error):
    """The problems that a schema error holds, a line each."""
    known = ", ".join(sorted(error.schema.get("properties", {})))
    if error.validator == "additionalProperties":
        for key in sorted(set(error.instance) - set(error.schema["properties"]), key=str):
            yield _problem([*error.path, key], error.instance[key], f"unknown key; known: {known}")
    elif error.validator == "required":
        for key in sorted(set(error.validator_value) - set(error.instance)):
            yield f"{_path([*error.path, key])}: missing; needed here: {known}"
    elif "propertyNames" in error.absolute_schema_path:
        yield f"{_path([*error.path, error.instance])}: name must be {_allowed(error.schema)}"
    else:
        yield _problem(error.path, error.instance, f"must be {_allowed(error.schema)}")


def _contradictions(config):
    """Problems between values that are each allowed."""
    for section in WITH_OSCILLATOR:
    for section in (
        "curves",
        "motions",
        "collisions",
        "optima",
        "migration",
        "release_scans",
        "design_rules",
    ):
    sections = "curves motions collisions optima migration release_scans harmonics"
    for section in sections.split():
    for section in REFERRING:
        for name, entry in config[section].items():
            yield from _unknown(
                [section, name, "oscillator"], entry["oscillator"], config["oscillators"]
            )
    settling = config["settling"]
    if settling["limit"] < settling["patience"]:
        reason = f"must be at least settling.patience = {settling['patience']} (it comes later)"
        yield _problem(["settling", "limit"], settling["limit"], reason)
    for name, oscillator in config["oscillators"].items():
        yield from _reversed(["oscillators", name, "frequencies"], oscillator["frequencies"])
    for name, optimum in config["optima"].items():
        yield from _reversed(["optima", name, "clearances"], optimum["clearances"])
    for name, scan in config["release_scans"].items():
        yield from _reversed(["release_scans", name, "frequencies"], scan["frequencies"])
    for name, model in config["contact_model"].items():
        if model["smallest_restitution"] == 1:
            reason = "must be less than 1 (where the map ends)"
            yield _problem(["contact_model", name, "smallest_restitution"], 1, reason)
        for key in ("restitutions", "frequencies"):
            yield from _not_increasing(["contact_model", name, key], model[key])
    for name, limit in config["rigid_limit"].items():
        for key in ("frequencies", "stiffnesses"):
            yield from _reversed(["rigid_limit", name, key], limit[key])
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
            yield _problem(path, entry["implicit_passages"], reason)
    for name, entry in config["balance_map"].items():
        yield from _wrong_map(["balance_map", name], entry)
    for name, curve in config["curves"].items():
        yield from _wrong_stages(["curves", name], curve)
    for name, scene in config["harmonics"].items():
        yield from _part_of_damper(["harmonics", name], scene)
    for name, figure in config["figures"].items():
        yield from _wrong_data(["figures", name, "data"], figure, config)


def _unknown(path, value, known):
    if value not in known:
        yield _problem(path, value, f"must be one of {', '.join(known)}")


def _reversed(path, span):
    if span["first"] >= span["last"]:
        reason = f"must be less than last = {span['last']!r} (a range ascends)"
        yield _problem([*path, "first"], span["first"], reason)


def _not_increasing(path, values):
    if sorted(set(values)) != values:
        yield _problem(path, values, "must increase (each is looked at once, in order)")
def _wrong_grid(path, grid, oscillators):
    for key in ("mass_ratios", "restitutions", "contact_stiffnesses", "frequencies"):
        if any(first >= second for first, second in itertools.pairwise(grid[key])):
            yield _problem([*path, key], grid[key], "must increase (a grid ascends)")
    linear = oscillators.get(grid["oscillator"], {}).get("linear_frequency", 0)
    if grid["frequencies"][0] <= linear:
        reason = f"must lie above the linear frequency {linear!r} (the rules hold above it)"
        yield _problem([*path, "frequencies"], grid["frequencies"], reason)


def _wrong_stages(path, curve):
    if "branches" in curve["stages"] and "response" not in curve["stages"]:
        reason = "must hold response with branches (orbits are followed from the motions found)"
        yield _problem([*path, "stages"], curve["stages"], reason)
    if "design" in curve["stages"] and curve["restitution"] != 1:
        reason = "must be 1 with the stage design (harmonic balance knows elastic contact only)"
        yield _problem([*path, "restitution"], curve["restitution"], reason)
    if curve["clearance"] == "rule" and curve["stages"] != ["design"]:
        reason = "must be a number with stages beside design (the designs table lists the rule)"
        yield _problem([*path, "clearance"], curve["clearance"], reason)


def _part_of_damper(path, scene):
    keys = ("mass_ratio", "clearance", "restitution", "contact_stiffness")
    given = [key for key in keys if key in scene]
    if given:
        for key in sorted(set(keys) - set(given)):
            words = f"needed with {', '.join(given)} (a damper is whole or absent)"
            yield f"{_path([*path, key])}: missing; {words}"
def _wrong_map(path, entry):
    yield from _reversed([*path, "frequency_ratios"], entry["frequency_ratios"])
    yield from _reversed([*path, "values"], entry["values"])
    changing = entry["parameter"]
    least, most = MAPPED[changing]
    for end, value in entry["values"].items():
        if not least <= value <= most:
            reason = f"must be from {least} to {most} (bounds of {changing})"
            yield _problem([*path, "values", end], value, reason)
    for name in MAPPED:
        if name == changing and name in entry:
            reason = "must be left out (it changes from row to row)"
            yield _problem([*path, name], entry[name], reason)
        elif name != changing and name not in entry:
            yield f"{_path([*path, name])}: missing; needed where {changing} changes"


def _wrong_data(path, figure, config):
    kind = figure["kind"]
    known = SCHEMATICS if kind == "schematic" else config[SECTIONS[kind]]
    for name in figure["data"]:
        yield from _unknown(path, name, known)
        if (
            kind in ("design", "response", "branches")
            and name in known
            and kind not in known[name]["stages"]
        ):
            reason = f"must hold {kind} (what {'.'.join(path[:2])} draws)"
            yield _problem(["curves", name, "stages"], known[name]["stages"], reason)


def _allowed(schema):
    """What a schema allows and why, in words."""
    kinds = schema.get("type", [])
    words = [" or ".join(TYPES[kind] for kind in ([kinds] if isinstance(kinds, str) else kinds))]
    if "enum" in schema:
        words.append(f"one of {', '.join(map(str, schema['enum']))}")
    words += [phrase.format(schema[key]) for key, phrase in BOUNDS.items() if key in schema]
    reason = f" ({schema['description']})" if "description" in schema else ""
    return ", ".join(filter(None, words)) + reason


def _problem(path, value, reason):
    return f"{_path(path)} = {reprlib.repr(value)}: {reason}"


def _path(path):
    return ".".join(map(str, path)) or "configuration"
