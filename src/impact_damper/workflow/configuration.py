"""Validation of the workflow's configuration before any job starts, with a line per problem.

The configuration has sections such as `curves` with freely named entries.
"""

from pathlib import Path

import yaml
from pydantic import ValidationError

from impact_damper.workflow.models import Configuration
from impact_damper.workflow.models.messages import dotted, problem
from impact_damper.workflow.models.section import parts
from impact_damper.workflow.models.values import NUMBER, RANGE
from impact_damper.workflow.registry import KINDS, section_of
from impact_damper.workflow.workloads import workloads

# If the C library libyaml is installed, its loader is used: it is several times as fast.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class ConfigurationError(ValueError):
    """A configuration that cannot be run; the message has a line for each problem."""


def check_configuration(config) -> None:
    """Raise if the configuration cannot be run.

    First each value is checked by itself. If all are allowed, combinations of values are checked
    for contradictions, and if there are none, the amount of work is checked.

    Parameters
    ----------
    config : dict
        The merged configuration.

    Raises
    ------
    ConfigurationError
        With a line for each problem: the key, its value, what is allowed and why.
    """
    try:
        checked = Configuration.model_validate(config)
    except ValidationError as error:
        lines = problems_of(error)
    else:
        lines = [x for path, part in parts(checked) for x in part.contradictions(path, checked)]
        lines = lines or list(workloads(checked))
    if lines:
        raise ConfigurationError("\n".join(dict.fromkeys(lines)))


def problems_of(error) -> list:
    """Return a line for each problem that pydantic found, in the order of the keys."""
    details = error.errors(include_url=False)
    # Paths mix names and positions in lists, which Python cannot compare.
    return [_line(detail) for detail in sorted(details, key=lambda d: [*map(str, d["loc"])])]


def without_left_out(config) -> dict:
    """Return the configuration without the entries that are set to null.

    A second configuration file removes an entry of the first file by setting it to null. Figures
    then draw their remaining entries; a figure without remaining entries is removed too.
    """
    kept = {
        key: {name: entry for name, entry in value.items() if entry is not None}
        if isinstance(value, dict)
        else value
        for key, value in config.items()
    }
    figures = kept.get("figures")
    for name, figure in list(figures.items()) if isinstance(figures, dict) else []:
        kind = figure.get("kind") if isinstance(figure, dict) else None
        known = isinstance(kind, str) and kind in KINDS
        entries = config.get(section_of(kind)) if known else None
        if not isinstance(entries, dict) or not isinstance(figure.get("data"), list):
            continue
        left_out = [key for key, entry in entries.items() if entry is None]
        data = [key for key in figure["data"] if key not in left_out]
        if data:
            figures[name] = figure | {"data": data}
        else:
            del figures[name]
    return kept


def check_file(path) -> None:
    """Raise if a YAML file cannot be read, or if a mapping in it has a key twice.

    A YAML reader would silently keep the last value of such a key.

    Raises
    ------
    ConfigurationError
        With a line for each problem: the file, its line and the key.
    """
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


def _line(detail):
    """Return the line that reports one error of pydantic."""
    path = [key for key in detail["loc"] if key not in (NUMBER, RANGE)]
    if path[-1:] == ["[key]"]:
        return f"{dotted(path[:-1])}: name {detail['msg']}"
    if detail["type"] == "needed":
        return f"{dotted(path)}: {detail['msg']}"
    return problem(path, detail["input"], detail["msg"])
