"""Whether random starts in the literal ball lead to collisions (section 3, claim 8)."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.datasets import save
from impact_damper.parameters import Damper, Oscillator
from impact_damper.response import collisions

job = ChainMap(*snakemake.params)
shares = collisions(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    job["frequency"],
    radius=job["radius"],
    seed=job["seed"],
)
save(shares, snakemake.output[0])
