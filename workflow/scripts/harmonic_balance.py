"""Harmonic-balance response and suppression band of a damper (section 2, figures 3, 5 and 8)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np
import xarray as xr

from impact_damper.data.datasets import save
from impact_damper.stages.harmonic_balance import (
    harmonic_balance_response,
    optimum_clearance,
    suppression_band,
)
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
oscillator = Oscillator(**job["oscillator"])
given = job["damper"]
if given["clearance"] == "rule":
    given = given | {"clearance": optimum_clearance(oscillator, given["mass_ratio"])}
damper = Damper(**given)
response = harmonic_balance_response(
    oscillator,
    damper,
    np.linspace(*job["frequencies"]),
)
band = suppression_band(oscillator, damper)
save(xr.merge([response, band], combine_attrs="override"), snakemake.output[0])
