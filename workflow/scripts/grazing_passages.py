"""Contacts near grazing that integrators miss, counted over random passages."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.stages.missed_contacts import missed_contacts
from impact_damper.system.parameters import Oscillator

job = ChainMap(*snakemake.params)
depths, tolerances, steps = job["depths"], job["tolerances"], job["steps"]
steps = np.geomspace(steps["first"], steps["last"], tolerances["points"])
found = missed_contacts(
    Oscillator(**job["oscillator"]),
    job["frequency"],
    passages=job["passages"],
    implicit_passages=job["implicit_passages"],
    radius=job["radius"],
    depths=np.geomspace(depths["first"], depths["last"], depths["points"]),
    tolerances=np.geomspace(tolerances["first"], tolerances["last"], tolerances["points"]),
    steps=[int(n) for n in steps.round()],
    seed=job["seed"],
)
save(found, snakemake.output[0])
