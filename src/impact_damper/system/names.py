"""Misspelt names are answered with the nearest known one. This module imports no NumPy."""

import difflib
import inspect
from functools import wraps


def nearest(name, known) -> str:
    """Return a question that proposes the known name nearest to `name`, or nothing."""
    found = difflib.get_close_matches(name, known, 1) if isinstance(name, str) else []
    return f"; did you mean {found[0]}?" if found else ""


def names_arguments(function):
    """Return a function, or a class, that answers an unknown argument with the nearest known one.

    Raises
    ------
    TypeError
        When called with an unknown keyword, or with too many arguments without a name; the message
        lists the known ones.
    """
    if inspect.isclass(function):
        function.__init__ = _checked(function.__init__, function.__name__)
        return function
    return _checked(function, function.__name__)


def _checked(function, title):
    parameters = inspect.signature(function).parameters
    if any(each.kind in (each.VAR_KEYWORD, each.VAR_POSITIONAL) for each in parameters.values()):
        return function
    known = [name for name in parameters if name != "self"]
    by_place = [each for each in parameters.values() if each.kind is each.POSITIONAL_OR_KEYWORD]

    @wraps(function)
    def checked(*args, **kwargs):
        for name in kwargs:
            if name not in parameters:
                raise TypeError(
                    f"{title}() has no argument {name!r}; known: {', '.join(known)}"
                    f"{nearest(name, known)}"
                )
        if len(args) > len(by_place):
            raise TypeError(
                f"{title}() has too many arguments without a name; known: {', '.join(known)}"
            )
        return function(*args, **kwargs)

    return checked
