"""The contact model over restitution and load, and contacts of motions in it."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.contact_model import contact_model, spread_loads
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
model = contact_model(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    job["frequencies"],
    np.linspace(*job["map"]["restitutions"]),
    spread_loads(*job["map"]["loads"]),
    used=job["used"],
    starts=job["starts"],
    periods=job["periods"],
    seed=job["seed"],
    settling=Settling(**job["settling"]),
)
save(model, snakemake.output[0])
