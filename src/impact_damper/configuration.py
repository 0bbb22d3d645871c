"""Validation of the workflow's configuration: every problem in one line, before any job starts."""

import math
import numbers
import re

import jsonschema
import yaml

from impact_damper.contradictions import SECTIONS, contradictions, dotted, problem

TYPES = {
    "object": "keys with values",
    "array": "a list",
    "string": "text",
    "number": "a finite number",
    "integer": "a whole number",
}

# libyaml's where it is there, which is many times as fast.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

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
    problems = problems or list(contradictions(config))
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
    nodes = [yaml.compose(text, Loader=LOADER)]
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
            yield problem([*error.path, key], error.instance[key], f"unknown key; known: {known}")
    elif error.validator == "required":
        for key in sorted(set(error.validator_value) - set(error.instance)):
            yield f"{dotted([*error.path, key])}: missing; needed here: {known}"
    elif "propertyNames" in error.absolute_schema_path:
        yield f"{dotted([*error.path, error.instance])}: name must be {_allowed(error.schema)}"
    else:
        yield problem(error.path, error.instance, f"must be {_allowed(error.schema)}")


def _allowed(schema):
    """What a schema allows and why, in words."""
    kinds = schema.get("type", [])
    words = [" or ".join(TYPES[kind] for kind in ([kinds] if isinstance(kinds, str) else kinds))]
    if "enum" in schema:
        words.append(f"one of {', '.join(map(str, schema['enum']))}")
    words += [phrase.format(schema[key]) for key, phrase in BOUNDS.items() if key in schema]
    reason = f" ({schema['description']})" if "description" in schema else ""
    return ", ".join(filter(None, words)) + reason
