"""Error messages for misspelt names, which propose the nearest known name.

This module imports no NumPy, because Snakemake reads it at every dry run.
"""

import difflib
import inspect
from functools import wraps


def nearest(name, known) -> str:
    """Return "; did you mean ...?" with the known name nearest to `name`, or "" if none is near."""
    matches = difflib.get_close_matches(name, known, 1) if isinstance(name, str) else []
    return f"; did you mean {matches[0]}?" if matches else ""


def names_arguments(function):
    """Decorate a function or class so that a wrong argument raises a helpful TypeError.

    A call with an unknown keyword, or with too many positional arguments, raises TypeError. The
    message lists the known arguments, and for an unknown keyword proposes the nearest of them.

    Returns
    -------
    callable
        The decorated function, or the same class with a decorated `__init__`. A function that takes
        `*args` or `**kwargs` is returned unchanged.
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
    positional = [each for each in parameters.values() if each.kind is each.POSITIONAL_OR_KEYWORD]

    @wraps(function)
    def checked(*args, **kwargs):
        for name in kwargs:
            if name not in parameters:
                raise TypeError(
                    f"{title}() has no argument {name!r}; known: {', '.join(known)}"
                    f"{nearest(name, known)}"
                )
        if len(args) > len(positional):
            raise TypeError(
                f"{title}() has too many arguments without a name; known: {', '.join(known)}"
            )
        return function(*args, **kwargs)

    return checked
