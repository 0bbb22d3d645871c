"""Types of values in YAML files, the base class of sections, and messages about problems.

The types are strict: 3.0 is no whole number; NaN, infinity and text are no numbers.
"""

import re
import reprlib
from pathlib import Path
from typing import Annotated, Literal

import yaml
from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Tag,
    ValidationError,
    confloat,
    conint,
    constr,
    model_validator,
)
from pydantic_core import PydanticCustomError, core_schema

from impact_damper.model.bounds import POINTS_RANGE, RUNS_RANGE, nearest
from impact_damper.model.text import plain

# pydantic inserts one of these words among the keys that lead to a wrong value. They are not keys.
NUMBER, RANGE = "<number>", "<range>"


class Allowed:
    """The allowed values of a key. A message about a wrong value is "must be", followed by `words`.

    Besides pydantic's checks, a list or a mapping must pass the function `test`, if one is given.
    """

    def __init__(self, words, meaning="", why="", test=None):
        self.words, self.test = words, test
        self.meaning = "; ".join(filter(None, (meaning, why)))

    def __str__(self):
        return f"{self.words} ({self.meaning})" if self.meaning else self.words

    def __get_pydantic_core_schema__(self, source, handler):
        if self.test:
            return core_schema.no_info_before_validator_function(self._tested, handler(source))
        return core_schema.no_info_wrap_validator_function(self._checked, handler(source))

    def _tested(self, value):
        if not self.test(value):
            raise self._error()
        return value

    def _checked(self, value, handler):
        try:
            handler(value)
        except ValidationError:
            raise self._error() from None
        # Return the value as the user wrote it. pydantic would turn the integer 2 into 2.0.
        return value

    def _error(self, reason=""):
        allowed = {"allowed": f"{self}{reason}"}
        return PydanticCustomError("allowed", "must be {allowed}", allowed)


def number(meaning="", *, above=None, least=None, most=None, why="", also=""):
    """Return the pydantic type of finite numbers within bounds.

    Messages contain `why`, the reason for the bounds, and `also`, another kind of allowed values.
    """
    bounds = {"greater than": above, "at least": least, "at most": most}
    words = [f"a finite number{also and f' or {also}'}", *_bounds(bounds)]
    kind = confloat(strict=True, allow_inf_nan=False, gt=above, ge=least, le=most)
    return Annotated[kind, Allowed(", ".join(words), meaning, why)]


def number_or_word(word, meaning, **bounds):
    """Return a pydantic type. It allows finite numbers within bounds, and the text `word`."""
    of_number = number(meaning, **bounds, also="text")
    words = f"{of_number.__metadata__[-1].words}, of the form {word}"
    return Annotated[of_number | Literal[word], Allowed(words, meaning)]


def number_or_range(model, meaning, **bounds):
    """Return a pydantic type. It allows finite numbers, and mappings that `model` accepts."""
    of_number = number(meaning, **bounds, also="keys with values")

    def kind(value):
        return RANGE if isinstance(value, dict | model) else NUMBER

    either = Annotated[of_number, Tag(NUMBER)] | Annotated[model, Tag(RANGE)]
    return Annotated[either, Discriminator(kind)]


def count(meaning, *, least, most, why=""):
    """Return the pydantic type of whole numbers from `least` to `most`, for the reason `why`."""
    words = ["a whole number", *_bounds({"at least": least, "at most": most})]
    kind = conint(strict=True, ge=least, le=most)
    return Annotated[kind, Allowed(", ".join(words), meaning, why)]


def points_of(meaning):
    """Return the pydantic type of a key that gives a number of grid points."""
    return count(meaning, **POINTS_RANGE)


def starts_of(meaning):
    """Return the pydantic type of a key that gives a number of random starts."""
    return count(f"random starts {meaning}", **RUNS_RANGE)


def text(meaning, *, pattern="", least=0):
    """Return the pydantic type of texts of `least` or more characters that match `pattern`."""
    words = ["text"]
    words += [f"of the form {pattern}"] if pattern else []
    words += [f"with {least} or more characters"] if least else []
    kind = constr(strict=True, min_length=least, pattern=f"^(?:{pattern})$" if pattern else None)
    return Annotated[kind, Allowed(", ".join(words), meaning)]


def choice(meaning, *words):
    """Return the pydantic type that allows only the texts `words`."""
    return Annotated[Literal[words], Allowed(f"one of {', '.join(words)}", meaning)]


def several(item, meaning="", *, least=0, most=None, distinct=False):
    """Return the pydantic type of lists of `item`. With `distinct` no entry may occur twice."""
    words = ["a list"]
    if least == most:
        words += [f"with {least} entries"]
    else:
        words += [f"with {least} or more entries"] if least else []
        words += [f"with {most} entries at most"] if most is not None else []
    words += ["without repetition"] if distinct else []

    def test(values):
        return (
            isinstance(values, list)
            and least <= len(values)
            and (most is None or len(values) <= most)
            and not (distinct and any(x in values[:i] for i, x in enumerate(values)))
        )

    return Annotated[list[item], Allowed(", ".join(words), meaning, test=test)]


def entries(model):
    """Return the pydantic type of mappings with any keys, whose values `model` accepts."""

    def test(value):
        return isinstance(value, dict) and len(value) > 0

    words = "keys with values, with 1 or more entries"
    return Annotated[dict[NAME, model], Allowed(words, test=test)]


def _bounds(bounds):
    return [f"{word} {_shown(bound)}" for word, bound in bounds.items() if bound is not None]


def _shown(bound):
    return str(bound) if isinstance(bound, int) else plain(bound)


NAME = text("a name becomes part of a file name", pattern="[A-Za-z0-9][A-Za-z0-9_]{0,63}")

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # CSafeLoader is faster, but needs libyaml
# Numbers with an exponent. YAML 1.1 reads 2.0e+5 as a number, but 2e5, 2.0e5 and 2e+5 as text.
SCIENTIFIC = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+")


class ConfigurationError(ValueError):
    """A configuration that cannot be run; the message has a line for each problem."""


class Section(BaseModel):
    """A mapping in a YAML file. Unknown keys and missing keys without a default are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    def contradictions(self, path, config):
        """Yield messages about contradictory values. `path`: keys from `config` to `self`."""
        yield from ()

    @model_validator(mode="wrap")
    @classmethod
    def _name_keys(cls, value, handler):
        try:
            return handler(value)
        except ValidationError as error:
            details = error.errors(include_url=False)
        raise ValidationError.from_exception_data(
            cls.__name__, [cls._worded(value, detail) for detail in details]
        )

    @classmethod
    def _worded(cls, value, detail):
        kind, path, given = detail["type"], detail["loc"], detail["input"]
        known = sorted(cls.model_fields)
        if not path:
            words = "must be keys with values"
        elif kind in ("extra_forbidden", "invalid_key"):
            if kind == "invalid_key":  # the key is not text; pydantic gives the key, not its value
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
    """Yield a pair for each `Section` in `value`: the keys that lead to it, and the `Section`."""
    if isinstance(value, Section):
        yield path, value
        for key in type(value).model_fields:
            yield from parts(getattr(value, key), (*path, key))
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from parts(entry, (*path, key))


def problem(path, value, reason) -> str:
    """Return the line that reports a wrong value: path of keys, value, and why it is wrong."""
    if isinstance(value, str) and SCIENTIFIC.fullmatch(value):
        known = yaml.safe_dump(float(value)).split()[0]
        reason += f"; YAML takes this for text, and {known} for a number"
    return f"{dotted(path)} = {reprlib.repr(value)}: {reason}"


def missing(path, reason) -> str:
    """Return the line that reports a missing key."""
    return f"{dotted(path)}: missing; {reason}"


def increasing(path, values, reason):
    """Yield a message if the values of a list do not increase."""
    if sorted(set(values)) != values:
        yield problem(path, values, f"must increase ({reason})")


def one_of(name, known) -> str:
    """Return "must be one of ..." with all `known` names, and a remark if `name` resembles one."""
    return f"must be one of {', '.join(known)}{nearest(name, known)}"


def dotted(path) -> str:
    """Return a path of keys, joined by dots. Long or unprintable keys are shortened and quoted."""

    def shown(key):
        whole = isinstance(key, str) and key.isprintable() and len(key) <= 80
        return key if whole else reprlib.repr(key)

    return ".".join(map(shown, path)) or "configuration"


def problems_of(error) -> list:
    """Return a message for each problem that pydantic found, sorted by the path of keys."""
    details = error.errors(include_url=False)
    # A path holds keys (text) and positions in lists (int). Python cannot compare text with int.
    return [_line(detail) for detail in sorted(details, key=lambda d: [*map(str, d["loc"])])]


def _line(detail):
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
        words = f"must be YAML in UTF-8, indented by spaces: {reason}"
        raise ConfigurationError(f"{name}: {words}") from None
    problems, seen, nodes = [], set(), [root]
    while nodes:
        node = nodes.pop()
        # With YAML aliases a node can occur more than once, or even contain itself.
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
