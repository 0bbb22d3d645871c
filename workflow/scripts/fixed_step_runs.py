"""What becomes of the quiet motion with fixed steps, over stiffness and step."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.datasets import save
from impact_damper.parameters import Damper, Oscillator
from impact_damper.stable_steps import stable_steps

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
