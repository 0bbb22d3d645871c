"""Reference motions of the scenes, test cases on which methods are compared, in 80-bit arithmetic.

    PYTHONPATH=src:tests python -m references.extended.scenes > workflow/resources/references.json

writes the file again from the section `scenes` of `config/config.yaml`. Chaotic scenes are omitted,
because no method can follow them to the end.
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
        damper = Damper(**pick(Damper, config | scene)) if "mass_ratio" in scene else None
        oscillator = Oscillator(**pick(Oscillator, config["oscillators"][scene["oscillator"]]))
        parameters = describe(oscillator, damper) | {"frequency": scene["frequency"]}
        yield name, parameters, np.array(scene["state"], float), scene["periods"]


def packed(parameters):
    """Return the packed parameters from a dict of parameters that `configured_scenes` yields."""
    damper = Damper(**pick(Damper, parameters)) if "mass_ratio" in parameters else None
    return pack(Oscillator(**pick(Oscillator, parameters)), damper, parameters["frequency"])


def reference(parameters, state, periods):
    """Return the entry of the file for one scene, rounded to doubles.

    A RuntimeError says that a run with a smaller tolerance and shorter steps gives another motion.
    """
    p = packed(parameters)
    period, start = 2 * math.pi / p[FREQUENCY], 0.5 * math.pi / p[FREQUENCY]
    times = start + period * np.arange(1, periods + 1)
    run = extended.run(p, state, start, times)
    other = extended.run(p, state, start, times, tolerance=1e-22, longest=0.02)
    if run.begun != other.begun or np.max(np.abs(run.states - other.states)) > 1e-14:
        raise RuntimeError(f"{parameters}: the motion depends on tolerance and step")
    return {
        "parameters": parameters,
        "first": state.tolist(),
        "end": float(times[-1]),
        "state": run.states[-1].astype(float).tolist(),
        "amplitude": float(np.max(np.abs(run.extremes))),
        "contact_times": run.contacts[:, 1].astype(float).tolist(),
    }


if __name__ == "__main__":
    found = {name: reference(*scene) for name, *scene in configured_scenes()}
    print(json.dumps(found, indent=1))
