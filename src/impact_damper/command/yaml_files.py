"""Check YAML files, with a line for each problem."""

from pathlib import Path

import yaml

from impact_damper.command.messages import dotted, problem
from impact_damper.command.values import NUMBER, RANGE

# If the C library libyaml is installed, its loader is used: it is several times as fast.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class ConfigurationError(ValueError):
    """A configuration that cannot be run; the message has a line for each problem."""


def problems_of(error) -> list:
    """Return a line for each problem that pydantic found, in the order of the keys."""
    details = error.errors(include_url=False)
    # Paths mix names and positions in lists, which Python cannot compare.
    return [_line(detail) for detail in sorted(details, key=lambda d: [*map(str, d["loc"])])]


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
