"""Validation of the workflow's configuration before any job starts, with a line per problem.

The configuration has sections such as `curves` with freely named entries.
"""

from pydantic import ValidationError

from chatterjee1995.workflow.models import Configuration
from chatterjee1995.workflow.registry import KINDS, section_of
from chatterjee1995.workflow.workloads import workloads
from impact_damper.command.section import parts
from impact_damper.command.yaml_files import ConfigurationError, problems_of


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
