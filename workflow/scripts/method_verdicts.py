"""Verdicts of integrators by tolerance, against the truth."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.stages.method_verdicts import make_scene, verdicts
from impact_damper.system.parameters import Damper, Oscillator

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
