"""Every branch of periodic orbits with a damper, stable or not (figures 5, 8 and 10)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.data.datasets import load, save
from impact_damper.stages.branches import complete_branches
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
branches = complete_branches(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    job["frequencies"],
    [load(path) for path in snakemake.input.motions],
    progress=snakemake.wildcards.curve,
)
save(branches, snakemake.output[0])
