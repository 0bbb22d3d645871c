"""What becomes of the quiet motion with fixed steps, over stiffness and step."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.stages.stable_steps import stable_steps
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
stiffnesses, scaled = job["stiffnesses"], job["scaled_steps"]
found = stable_steps(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    job["frequency"],
    stiffnesses=np.geomspace(stiffnesses["first"], stiffnesses["last"], stiffnesses["points"]),
    scaled_steps=np.geomspace(scaled["first"], scaled["last"], scaled["points"]),
    most_steps=job["most_steps"],
    periods=job["periods"],
)
save(found, snakemake.output[0])
