"""Base of the models: a part of the configuration with a fixed set of keys."""

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from impact_damper.command.messages import problem
from impact_damper.model.bounds import nearest


class Section(BaseModel):
    """Keys with values. An unknown key is an error, as is a missing key without a default.

    Subclasses state their keys as fields. Their method `contradictions` finds combinations of
    values that contradict each other although each value is allowed.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    def contradictions(self, path, config):
        """Yield a line for each contradiction between values.

        Parameters
        ----------
        path : tuple of str
            Keys that lead to this section.
        config : Section
            The whole configuration, whose values are allowed individually.
        """
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
        """Return an error of pydantic with the message of this package, its path and its value."""
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


def increasing(path, values, reason):
    """Yield a line unless a list increases."""
    if sorted(set(values)) != values:
        yield problem(path, values, f"must increase ({reason})")
