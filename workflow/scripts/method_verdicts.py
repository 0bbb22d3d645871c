"""Verdicts of integrators by tolerance, against the truth."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.datasets import save
from impact_damper.parameters import Damper, Oscillator
from impact_damper.verdicts import make_scene, verdicts

job = ChainMap(*snakemake.params)
oscillator = Oscillator(**job["oscillator"])
scenes = {}
for name, given in (job["damped"] | job["free"]).items():
    keys = [key for key in ("mass_ratio", "clearance", "restitution") if key in given]
    named = {key: given.pop(key) for key in keys}
    damper = Damper(**named, contact_stiffness=job["contact_stiffness"]) if named else None
    scenes[name] = make_scene(oscillator, damper, **given)
tolerances, steps = job["tolerances"], job["steps"]
steps = np.geomspace(steps["first"], steps["last"], tolerances["points"])
found = verdicts(
    scenes,
    np.geomspace(tolerances["first"], tolerances["last"], tolerances["points"]),
    [int(n) for n in steps.round()],
)
save(found, snakemake.output[0])
