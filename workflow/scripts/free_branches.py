"""Every branch of periodic orbits without a damper, stable or not (figure 2)."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.datasets import load, save
from impact_damper.parameters import Oscillator
from impact_damper.periodic import complete_branches

job = ChainMap(*snakemake.params)
branches = complete_branches(
    Oscillator(**job["oscillator"]),
    None,
    job["frequencies"],
    [load(path) for path in snakemake.input.motions],
)
save(branches, snakemake.output[0])
