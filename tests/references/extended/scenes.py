"""Reference motions of the scenes, test cases on which methods are compared, in 80-bit arithmetic.

    PYTHONPATH=src:tests python -m references.extended.scenes > workflow/resources/references.json

writes the file again from the section `scenes` of `config/config.yaml`. The file is JSON with 21
significant digits, more than a double has. `json.loads(text, parse_float=numpy.longdouble)` keeps
all digits, and plain `json.loads` rounds to doubles. Chaotic scenes are omitted, because no method
can follow them to the end. Each other scene has the entries

parameters
    Parameters of oscillator and damper, and the frequency, so that a changed scene is noticed.
start, end
    Times of the run, doubles: W T = pi/2, and `start + periods * (2 pi/W)` in double arithmetic.
first, state
    Z1, Z1', Z2, Z2' at `start` and at `end`.
amplitude
    max |Z1| over the whole run.
last_amplitude
    max |Z1| over the last forcing cycle.
contacts
    Rows of wall, beginning, end, Z2' at both; null for a contact that has not ended.
error, contact_error
    Largest difference of state and extremes of Z1, and of the contacts, from a run with a smaller
    tolerance and shorter steps. The error of the time of a contact is the error of Z2 divided by
    the speed, so it is large for a contact that begins at a small speed.
growth
    Largest factor by which an error at an instant of the run grows until the end (see
    `extended.Run`).
margin
    Smallest distance of an extremum of Z2 to a wall, divided by the growth of an error until then.
    An error of this size could change the number of contacts.
"""

import json
import math
from pathlib import Path

import numpy as np
import yaml

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator, describe, pick
from references import extended

ROOT = Path(__file__).resolve().parents[3]
FILE = ROOT / "workflow" / "resources" / "references.json"


def configured_scenes():
    """Yield name, parameters, state and periods of each scene that is not chaotic."""
    config = yaml.safe_load((ROOT / "config" / "config.yaml").read_text())
    for name, scene in config["scenes"].items():
        if scene["motion"] == "chaotic":
            continue
        damper = None
        if "mass_ratio" in scene:
            damper = Damper(**pick(Damper, config | scene))
        oscillator = Oscillator(**pick(Oscillator, config["oscillators"][scene["oscillator"]]))
        parameters = describe(oscillator, damper) | {"frequency": scene["frequency"]}
        yield name, parameters, np.array(scene["state"], float), scene["periods"]


def packed(parameters):
    """Return the packed parameters from a dict of parameters, as `configured_scenes` yields it."""
    damper = Damper(**pick(Damper, parameters)) if "mass_ratio" in parameters else None
    return pack(Oscillator(**pick(Oscillator, parameters)), damper, parameters["frequency"])


def reference(parameters, state, periods):
    """Return the entry of the file for one scene, keyed by the name of the quantity."""
    p = packed(parameters)
    period, start = 2 * math.pi / p[FREQUENCY], 0.5 * math.pi / p[FREQUENCY]
    times = start + period * np.arange(1, periods + 1)
    run = extended.run(p, state, start, times)
    other = extended.run(p, state, start, times, tolerance=1e-22, longest=0.02)
    if run.begun != other.begun:
        raise RuntimeError(f"contacts: {run.begun} and {other.begun}")
    errors = {
        name: np.nanmax(np.abs(getattr(run, name) - getattr(other, name)), initial=0)
        for name in ("states", "extremes", "contacts")
    }
    return {
        "parameters": parameters,
        "start": start,
        "end": times[-1],
        "first": state,
        "state": run.states[-1],
        "amplitude": np.max(np.abs(run.extremes)),
        "last_amplitude": np.max(np.abs(run.extremes[-1])),
        "contacts": run.contacts,
        "error": max(errors["states"], errors["extremes"]),
        "contact_error": errors["contacts"],
        "growth": run.growth,
        "margin": run.margin,
    }


def _text(value):
    """Return the JSON text of a number, or of an array or a dictionary of numbers."""
    if isinstance(value, dict):
        return (
            f"{{{', '.join(f'{json.dumps(key)}: {_text(part)}' for key, part in value.items())}}}"
        )
    if np.ndim(value):
        return f"[{', '.join(_text(part) for part in value)}]"
    if not np.isfinite(value):
        return "null"
    return np.format_float_scientific(np.longdouble(value), precision=20, trim="-")


def as_text(references):
    """Return the text of the file, with a line for each quantity and for each contact."""
    scenes = []
    for name, quantities in references.items():
        lines = [f"    {json.dumps(key)}: {_text(value)}" for key, value in quantities.items()]
        lines = [line.replace("], [", "],\n      [") for line in lines]
        scenes.append(f"  {json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n  }")
    return "{\n" + ",\n".join(scenes) + "\n}\n"


if __name__ == "__main__":
    found = {name: reference(*scene) for name, *scene in configured_scenes()}
    print(as_text(found), end="")
