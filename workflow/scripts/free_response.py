"""Motions of the free oscillator and the ends of its branches (figure 2)."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.datasets import save
from impact_damper.ensemble import Settling
from impact_damper.parameters import Oscillator
from impact_damper.response import frequency_response

job = ChainMap(*snakemake.params)
response = frequency_response(
    Oscillator(**job["oscillator"]),
    None,
    np.linspace(*job["frequencies"]),
    **job["search"],
    settling=Settling(**job["settling"]),
    workers=snakemake.threads,
    progress=snakemake.wildcards.oscillator,
)
save(response, snakemake.output[0])
