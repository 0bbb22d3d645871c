"""Types of values in the configuration, each with a text on the values that it allows.

The types are strict: 3.0 is not a whole number, and neither NaN, infinity nor text is a number.
"""

from typing import Annotated, Literal

from pydantic import Discriminator, Tag, ValidationError, confloat, conint, constr
from pydantic_core import PydanticCustomError, core_schema

from impact_damper.model.bounds import POINTS_RANGE, RUNS_RANGE
from impact_damper.model.text import plain

# Tags that pydantic adds to the path of a number or a range. Keys cannot have these names.
NUMBER, RANGE = "<number>", "<range>"


class Allowed:
    """The words after "must be" that name allowed values; they replace pydantic's message.

    For a list or mapping `test` returns whether its type and length are allowed.
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
        # The value as the user wrote it: pydantic would turn the integer 2 into 2.0.
        return value

    def _error(self, reason=""):
        allowed = {"allowed": f"{self}{reason}"}
        return PydanticCustomError("allowed", "must be {allowed}", allowed)


def number(meaning="", *, above=None, least=None, most=None, why="", also=""):
    """Return the type of a finite number within bounds; `also` names another kind of value."""
    bounds = {"greater than": above, "at least": least, "at most": most}
    words = [f"a finite number{also and f' or {also}'}", *_bounds(bounds)]
    kind = confloat(strict=True, allow_inf_nan=False, gt=above, ge=least, le=most)
    return Annotated[kind, Allowed(", ".join(words), meaning, why)]


def number_or_word(word, meaning, **bounds):
    """Return the type of a finite number within bounds, or of one word."""
    of_number = number(meaning, **bounds, also="text")
    words = f"{of_number.__metadata__[-1].words}, of the form {word}"
    return Annotated[of_number | Literal[word], Allowed(words, meaning)]


def number_or_range(model, meaning, **bounds):
    """Return the type of a finite number within bounds, or of a range by the model `model`."""
    of_number = number(meaning, **bounds, also="keys with values")

    def kind(value):
        return RANGE if isinstance(value, dict | model) else NUMBER

    return Annotated[
        Annotated[of_number, Tag(NUMBER)] | Annotated[model, Tag(RANGE)], Discriminator(kind)
    ]


def count(meaning, *, least, most, why=""):
    """Return the type of a whole number within bounds."""
    words = ["a whole number", *_bounds({"at least": least, "at most": most})]
    kind = conint(strict=True, ge=least, le=most)
    return Annotated[kind, Allowed(", ".join(words), meaning, why)]


def points_of(meaning):
    """Return the type of the number of points of a grid."""
    return count(meaning, **POINTS_RANGE)


def starts_of(meaning):
    """Return the type of a number of random starts."""
    return count(f"random starts {meaning}", **RUNS_RANGE)


def text(meaning, *, pattern="", least=0):
    """Return the type of a text with at least `least` characters that matches a pattern."""
    words = ["text"]
    words += [f"of the form {pattern}"] if pattern else []
    words += [f"with {least} or more characters"] if least else []
    kind = constr(strict=True, min_length=least, pattern=f"^(?:{pattern})$" if pattern else None)
    return Annotated[kind, Allowed(", ".join(words), meaning)]


def choice(meaning, *words):
    """Return the type of a text that is one of the words."""
    return Annotated[Literal[words], Allowed(f"one of {', '.join(words)}", meaning)]


def several(item, meaning="", *, least=0, most=None, distinct=False):
    """Return the type of a list with entries of the type `item`."""
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


def entries(model, *, least=1):
    """Return the type of a mapping from freely chosen names to entries of the type `model`."""
    words = "keys with values" + (f", with {least} or more entries" if least else "")

    def test(value):
        return isinstance(value, dict) and len(value) >= least

    return Annotated[dict[NAME, model], Allowed(words, test=test)]


def _bounds(bounds):
    return [f"{word} {_shown(bound)}" for word, bound in bounds.items() if bound is not None]


def _shown(bound):
    return str(bound) if isinstance(bound, int) else plain(bound)


NAME = text("a name becomes part of a file name", pattern="[A-Za-z0-9][A-Za-z0-9_]{0,63}")
