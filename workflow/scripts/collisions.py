"""Whether random starts in the literal ball lead to collisions (section 3, claim 8)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.data.datasets import save
from impact_damper.stages.response import collisions
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
shares = collisions(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    job["frequency"],
    radius=job["radius"],
    seed=job["seed"],
)
save(shares, snakemake.output[0])
