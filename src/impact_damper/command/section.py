"""Base of the classes that check YAML files, and the lines that report problems."""

import re
import reprlib
from pathlib import Path

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from impact_damper.command.values import NUMBER, RANGE
from impact_damper.model.bounds import nearest

# The loader of the C library libyaml, if it is installed, is several times as fast.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
# Numbers with an exponent, which YAML 1.1 reads as text if point or sign is missing.
SCIENTIFIC = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+")


class ConfigurationError(ValueError):
    """A configuration that cannot be run; the message has a line for each problem."""


class Section(BaseModel):
    """Keys with values. Unknown keys are errors, and so are missing keys without a default."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    def contradictions(self, path, config):
        """Yield a line for each contradiction; `path` is the section's place in `config`."""
        yield from ()

    @model_validator(mode="wrap")
    @classmethod
    def _name_keys(cls, value, handler):
        """Report unknown and missing keys, with the keys known in this section."""
        try:
            return handler(value)
        except ValidationError as error:
            details = error.errors(include_url=False)
        raise ValidationError.from_exception_data(
            cls.__name__, [cls._worded(value, detail) for detail in details]
        )

    @classmethod
    def _worded(cls, value, detail):
        """Return an error of pydantic with a message of this package, the path and the value."""
        kind, path, given = detail["type"], detail["loc"], detail["input"]
        known = sorted(cls.model_fields)
        if not path:
            words = "must be keys with values"
        elif kind in ("extra_forbidden", "invalid_key"):
            if kind == "invalid_key":  # a key that is not text; pydantic reports the key as input
                given = value[given]
            kind = "unknown"
            words = f"unknown key; known: {', '.join(known)}{nearest(path[-1], known)}"
        elif kind == "missing":
            needed = sorted(key for key, each in cls.model_fields.items() if each.is_required())
            kind, words = "needed", f"missing; needed here: {', '.join(needed)}"
        else:
            words = detail["msg"]
        return {"type": PydanticCustomError(kind, words), "loc": path, "input": given}


def parts(value, path=()):
    """Yield each section inside a value, with its path of keys."""
    if isinstance(value, Section):
        yield path, value
        for key in type(value).model_fields:
            yield from parts(getattr(value, key), (*path, key))
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from parts(entry, (*path, key))


def problem(path, value, reason) -> str:
    """Return the line that reports a wrong value: path of keys, value and what it must be."""
    if isinstance(value, str) and SCIENTIFIC.fullmatch(value):
        known = yaml.safe_dump(float(value)).split()[0]
        reason += f"; YAML takes this for text, and {known} for a number"
    return f"{dotted(path)} = {reprlib.repr(value)}: {reason}"


def missing(path, reason) -> str:
    """Return the line that reports a missing key."""
    return f"{dotted(path)}: missing; {reason}"


def increasing(path, values, reason):
    """Yield a line unless a list increases."""
    if sorted(set(values)) != values:
        yield problem(path, values, f"must increase ({reason})")


def one_of(name, known) -> str:
    """Return the text "must be one of ..." with all known names, and the name nearest to `name`."""
    return f"must be one of {', '.join(known)}{nearest(name, known)}"


def dotted(path) -> str:
    """Return a path of keys as one key with dots; long or unprintable keys are quoted."""
    return (
        ".".join(
            key
            if isinstance(key, str) and key.isprintable() and len(key) <= 80
            else reprlib.repr(key)
            for key in path
        )
        or "configuration"
    )


def problems_of(error) -> list:
    """Return a line for each problem that pydantic found, in the order of the keys."""
    details = error.errors(include_url=False)
    # Paths mix names and positions in lists, which Python cannot compare.
    return [_line(detail) for detail in sorted(details, key=lambda d: [*map(str, d["loc"])])]


def _line(detail):
    """Return the line that reports one error of pydantic."""
    path = [key for key in detail["loc"] if key not in (NUMBER, RANGE)]
    if path[-1:] == ["[key]"]:
        return f"{dotted(path[:-1])}: name {detail['msg']}"
    if detail["type"] == "needed":
        return f"{dotted(path)}: {detail['msg']}"
    return problem(path, detail["input"], detail["msg"])


def check_file(path) -> None:
    """Raise ConfigurationError if a YAML file cannot be read, or has a key twice in one mapping."""
    name = Path(path).name
    try:
        root = yaml.compose(Path(path).read_bytes(), Loader=LOADER)
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        reason = " ".join(str(error).replace('in "<byte string>", ', "at ").split())
        raise ConfigurationError(
            f"{name}: must be YAML in UTF-8, indented by spaces: {reason}"
        ) from None
    problems, seen, nodes = [], set(), [root]
    while nodes:
        node = nodes.pop()
        # With aliases a node can occur more than once, or even contain itself.
        if id(node) in seen or not isinstance(node, yaml.CollectionNode):
            continue
        seen.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            nodes.extend(node.value)
            continue
        nodes.extend(value for _, value in node.value)
        known = set()
        for key in (key for key, _ in node.value if isinstance(key, yaml.ScalarNode)):
            if key.value in known:
                line, word = key.start_mark.line + 1, dotted([key.value])
                problems.append(f"{name}, line {line}: {word} stands twice: keep one")
            known.add(key.value)
    if problems:
        raise ConfigurationError("\n".join(problems))
