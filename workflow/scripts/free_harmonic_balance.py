"""Free response by harmonic balance, stable and unstable (figures 2, 5, 8 and 10)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.stages.harmonic_balance import harmonic_balance_response
from impact_damper.system.parameters import Oscillator

job = ChainMap(*snakemake.params)
response = harmonic_balance_response(
    Oscillator(**job["oscillator"]),
    None,
    np.linspace(*job["frequencies"]),
)
save(response, snakemake.output[0])
