"""Validation of the workflow's configuration: every problem in one line, before any job starts."""

import math
import numbers
import re
from pathlib import Path

import jsonschema
import yaml
from referencing import Registry
from referencing import jsonschema as dialects

from impact_damper.workflow.contradictions import SECTIONS, contradictions, dotted, problem
from impact_damper.workflow.workloads import workloads

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


# The schema of the whole configuration.
ROOT = "config.schema.yaml"


class ConfigurationError(ValueError):
    """A configuration that cannot be run; the message has a line for each problem."""


def read_schemas(folder) -> dict:
    """JSON schemas of a folder by file name, under which they refer to each other."""
    return {path.name: yaml.load(path.read_text(), LOADER) for path in Path(folder).glob("*.yaml")}


def check_configuration(config, schemas) -> None:
    """Raise if the configuration breaks the schema, contradicts itself or asks for too much.

    Parameters
    ----------
    config : dict
        The merged configuration.
    schemas : dict
        Of `read_schemas`, whose descriptions say what a key means; `ROOT` is that of the whole.

    Raises
    ------
    ConfigurationError
        Naming the key, the value, what is allowed and why, a line for each problem.
    """
    resources = [(name, dialects.DRAFT202012.create_resource(s)) for name, s in schemas.items()]
    validator = _Validator(schemas[ROOT], registry=Registry().with_resources(resources))
    # Paths may mix names and list positions, which have no order among themselves.
    errors = sorted(validator.iter_errors(config), key=lambda error: list(map(str, error.path)))
    problems = [line for error in errors for line in _lines(error)]
    # Contradictions are looked for only where every value is of its kind.
    problems = problems or list(contradictions(config)) or list(workloads(config))
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


def check_file(path) -> None:
    """Raise if a YAML file cannot be read, or if a key stands twice in it.

    Of a key that stands twice a reader would keep the last alone.

    Raises
    ------
    ConfigurationError
        Naming file, line and key, a line for each problem.
    """
    name = Path(path).name
    try:
        root = yaml.compose(Path(path).read_bytes(), Loader=LOADER)
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        told = " ".join(str(error).split())
        raise ConfigurationError(
            f"{name}: must be YAML in UTF-8, indented by spaces: {told}"
        ) from None
    problems, seen, nodes = [], set(), [root]
    while nodes:
        node = nodes.pop()
        # an alias leads to a node again, maybe to one that holds it
        if id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, yaml.MappingNode):
            keys = [(key.value, key) for key, _ in node.value if isinstance(key, yaml.ScalarNode)]
            known = set()
            for word, key in keys:
                if word in known:
                    line = key.start_mark.line + 1
                    problems.append(f"{name}, line {line}: {dotted([word])} stands twice: keep one")
                known.add(word)
            nodes.extend(value for _, value in node.value)
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
