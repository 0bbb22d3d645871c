"""Reader of the YAML file that describes a machine for the command `impact-damper`.

The file has the same keys as an entry of the section `machines` in the workflow's configuration. A
start is a random initial state, and a motion is quiet if it is below a displacement limit.
"""

import re
from pathlib import Path

import yaml
from pydantic import ValidationError

from impact_damper.command.machine_entry import MachineEntry
from impact_damper.command.messages import SCIENTIFIC
from impact_damper.command.yaml_files import (
    LOADER,
    ConfigurationError,
    check_file,
    problems_of,
)


class _Loader(LOADER):
    """YAML loader that reads 2e5 as a number; in YAML 1.1 it is text."""


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(f"(?:{SCIENTIFIC.pattern})$"), list("-+.0123456789")
)
# Values of keys that a file may leave out. With 73 starts, all of which lead to quiet motions, the
# lower end of the 95 % interval (Wilson) of the share is 0.95, the share required here.
DEFAULTS = {"candidates": 8, "starts": 73, "share": 0.95, "tolerances": {"gap": 0.2}}
POINTS = 9  # frequencies in the band


def read_machine_file(path) -> dict:
    """Return the content of a machine's file, checked, with defaults for the keys left out.

    Parameters
    ----------
    path : str or pathlib.Path
        Path of the file, in which `band` may also be a list of two frequencies.

    Returns
    -------
    dict
        The keys of an entry of `machines` in the configuration.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ConfigurationError
        If the file is not YAML or a value is not allowed, with a line for each problem.
    """
    check_file(path)
    given = yaml.load(Path(path).read_bytes(), _Loader)
    if not isinstance(given, dict):
        raise ConfigurationError(f"{Path(path).name}: must have keys with values, such as machine:")
    content = DEFAULTS | given
    band = content.get("band")
    if isinstance(band, list) and len(band) == 2:
        content["band"] = {"first": band[0], "last": band[1]}
    if isinstance(content.get("band"), dict):
        content["band"] = {"points": POINTS} | content["band"]
    try:
        entry = MachineEntry.model_validate(content)
    except ValidationError as error:
        raise ConfigurationError("\n".join(problems_of(error))) from None
    problems = list(entry.contradictions((), None))
    if problems:
        raise ConfigurationError("\n".join(problems))
    return content
