"""Validation of the workflow's configuration: every problem in one line, before any job starts."""

from pathlib import Path

import yaml
from pydantic import ValidationError

from impact_damper.workflow.models import Configuration
from impact_damper.workflow.models.messages import dotted, problem
from impact_damper.workflow.models.section import parts
from impact_damper.workflow.models.values import NUMBER, RANGE
from impact_damper.workflow.registry import KINDS, section_of
from impact_damper.workflow.workloads import workloads

# The loader of libyaml, where there is one, is several times as fast.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class ConfigurationError(ValueError):
    """A configuration that cannot be run; the message has a line for each problem."""


def check_configuration(config) -> None:
    """Raise if a value of the configuration is not allowed, contradicts another or asks too much.

    Parameters
    ----------
    config : dict
        The merged configuration.

    Raises
    ------
    ConfigurationError
        Naming the key, the value, what is allowed and why, a line for each problem. Contradictions
        are looked for only where each value is allowed, and amounts of work after these.
    """
    try:
        checked = Configuration.model_validate(config)
    except ValidationError as error:
        details = error.errors(include_url=False)
        # Paths mix names and positions in lists, which have no order among themselves.
        lines = [_line(detail) for detail in sorted(details, key=lambda d: [*map(str, d["loc"])])]
    else:
        lines = [x for path, part in parts(checked) for x in part.contradictions(path, checked)]
        lines = lines or list(workloads(checked))
    if lines:
        raise ConfigurationError("\n".join(dict.fromkeys(lines)))


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
        kind = figure.get("kind") if isinstance(figure, dict) else None
        known = isinstance(kind, str) and kind in KINDS
        entries = config.get(section_of(kind)) if known else None
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


def _line(detail):
    """The line on one error of pydantic."""
    path = [key for key in detail["loc"] if key not in (NUMBER, RANGE)]
    if path[-1:] == ["[key]"]:
        return f"{dotted(path[:-1])}: name {detail['msg']}"
    if detail["type"] == "needed":
        return f"{dotted(path)}: {detail['msg']}"
    return problem(path, detail["input"], detail["msg"])
