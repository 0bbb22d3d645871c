"""The reference page of the configuration: all keys, with their allowed values."""

from typing import get_args, get_origin

from chatterjee1995.sections.configuration import ENTRIES, Configuration, Settings
from impact_damper.command.section import NAME, Allowed, Section

HEAD = f"""# Reference of the configuration

Every key of `config.yaml` with its allowed values. This page is generated from the classes that
check the configuration, by `python -m chatterjee1995.sections.reference > config/reference.md`.
`NAME` stands for a name of your choice: {NAME.__metadata__[-1].words}.
The text after a semicolon in the column "meaning" is mostly the reason for a bound.
"""
COLUMNS = "| key | must be | meaning |\n|---|---|---|"


def reference() -> str:
    """Return the reference page of the configuration as Markdown."""
    fields = Settings.model_fields
    sections = {key: each.annotation for key, each in fields.items() if _section(each.annotation)}
    parts = [HEAD, "## Single values\n", _table(Configuration, fields.keys() - sections.keys())]
    for key, model in sections.items():
        parts += [f"## {key}\n", f"{model.__doc__}\n", _table(model)]
    for key, model in ENTRIES.items():
        parts += [f"## {key}.NAME\n", f"{model.__doc__}\n", _table(model)]
    return "\n".join(parts)


def _table(model, keys=None):
    fields = {key: each for key, each in model.model_fields.items() if keys is None or key in keys}
    return "\n".join([COLUMNS, *_rows("", fields), ""])


def _rows(prefix, fields):
    for key, field in fields.items():
        kind, key = field.annotation, prefix + key
        if get_origin(kind) is dict:
            kind, key = get_args(kind)[1], f"{key}.NAME"
        if _section(kind):
            yield from _rows(f"{key}.", kind.model_fields)
            continue
        allowed = _allowed(field.metadata) if kind is field.annotation else None
        allowed = allowed or _allowed(getattr(kind, "__metadata__", ()))
        allowed = allowed or _allowed(get_args(kind)[0].__metadata__)
        words = [allowed.words]
        if get_origin(kind) is list:
            words += [f"each {_item(get_args(kind)[0])}"]
        words += [f"the keys {', '.join(f'`{x}`' for x in model)}" for model in _ranges(kind)]
        words += [] if field.is_required() else ["may be left out"]
        yield f"| `{key}` | {'; '.join(words)} | {allowed.meaning} |"


def _item(kind):
    words, inner = _allowed(kind.__metadata__).words, get_args(kind)[0]
    return f"{words}, each {_item(get_args(inner)[0])}" if get_origin(inner) is list else words


def _ranges(kind):
    parts = [get_args(part)[0] for part in get_args(kind) if hasattr(part, "__metadata__")]
    return [part.model_fields for part in parts if _section(part)]


def _allowed(metadata):
    return next((x for x in reversed(metadata) if isinstance(x, Allowed)), None)


def _section(kind):
    return isinstance(kind, type) and issubclass(kind, Section)


if __name__ == "__main__":
    print(reference(), end="")
