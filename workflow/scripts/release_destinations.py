"""Where releases of the damper lead over frequency (section 5, figure 14)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.release_scan import release_scan
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
scan = release_scan(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    np.linspace(*job["frequencies"]),
    **job["search"],
    releases=job["releases"],
    lifetime=job["lifetime"],
    settling=Settling(**job["settling"]),
    workers=snakemake.threads,
    progress=snakemake.wildcards.scan,
)
save(scan, snakemake.output[0])
