"""Reference of the configuration, generated from the models: every key with its allowed values."""

from typing import get_args, get_origin

from chatterjee1995.sections.configuration import ENTRIES, Configuration, Settings
from impact_damper.command.section import Section
from impact_damper.command.values import NAME, Allowed

HEAD = f"""# Reference of the configuration

Every key of `config.yaml` with its allowed values. This page is generated from the classes that
check the configuration, by `python -m chatterjee1995.sections.reference > config/reference.md`.
`NAME` stands for a name of your choice: {NAME.__metadata__[-1].words}.
The text after a semicolon in the column "meaning" is mostly the reason for a bound.
"""
COLUMNS = "| key | must be | meaning |\n|---|---|---|"


def reference() -> str:
    """Return the page as Markdown."""
    sections = {
        key: field.annotation
        for key, field in Settings.model_fields.items()
        if _is_section(field.annotation)
    }
    single = [key for key in Settings.model_fields if key not in sections]
    parts = [HEAD, "## Single values\n", _table(Configuration, "", single)]
    for key, model in sections.items():
        parts += [f"## {key}\n", f"{model.__doc__}\n", _table(model, "", model.model_fields)]
    for key, model in ENTRIES.items():
        parts += [f"## {key}.NAME\n", f"{model.__doc__}\n", _table(model, "", model.model_fields)]
    return "\n".join(parts)


def _table(model, prefix, keys):
    """Return the Markdown table of some keys of a model, each with a prefix."""
    lines = [line for key in keys for line in _rows(prefix + key, model.model_fields[key])]
    return "\n".join([COLUMNS, *lines, ""])


def _rows(key, field):
    """Yield a line of the table for a field, or for each key inside the field."""
    kind = field.annotation
    if _is_section(kind):
        yield from _inner(f"{key}.", kind)
    elif get_origin(kind) is dict and _is_section(get_args(kind)[1]):
        yield from _inner(f"{key}.NAME.", get_args(kind)[1])
    elif get_origin(kind) is dict:
        allowed = _allowed(get_args(kind)[1].__metadata__)
        yield f"| `{key}.NAME` | {allowed.words} | {allowed.meaning} |"
    else:
        allowed = _allowed(field.metadata) or _allowed(get_args(kind)[0].__metadata__)
        words = [allowed.words]
        if get_origin(kind) is list:
            words += [f"each {_item(get_args(kind)[0])}"]
        words += [f"the keys {', '.join(f'`{x}`' for x in model)}" for model in _ranges(kind)]
        words += [] if field.is_required() else ["may be left out"]
        yield f"| `{key}` | {'; '.join(words)} | {allowed.meaning} |"


def _inner(prefix, model):
    """Yield the lines of all keys of a model."""
    for key, field in model.model_fields.items():
        yield from _rows(prefix + key, field)


def _item(kind):
    """Return the allowed values of an entry of a list."""
    words, inner = _allowed(kind.__metadata__).words, get_args(kind)[0]
    return f"{words}, each {_item(get_args(inner)[0])}" if get_origin(inner) is list else words


def _ranges(kind):
    """Return the keys of the range that may replace a number."""
    parts = [get_args(part)[0] for part in get_args(kind) if hasattr(part, "__metadata__")]
    return [part.model_fields for part in parts if _is_section(part)]


def _allowed(metadata):
    """Return the last `Allowed` in the metadata of a type, or None."""
    return next((x for x in reversed(metadata) if isinstance(x, Allowed)), None)


def _is_section(kind):
    return isinstance(kind, type) and issubclass(kind, Section)


if __name__ == "__main__":
    print(reference(), end="")
