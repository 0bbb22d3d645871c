"""Every branch of periodic orbits without a damper, stable or not (figure 2)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.data.datasets import load, save
from impact_damper.stages.branches import complete_branches
from impact_damper.system.parameters import Oscillator

job = ChainMap(*snakemake.params)
branches = complete_branches(
    Oscillator(**job["oscillator"]),
    None,
    job["frequencies"],
    [load(path) for path in snakemake.input.motions],
    progress=snakemake.wildcards.oscillator,
)
save(branches, snakemake.output[0])
