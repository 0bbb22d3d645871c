"""A steady motion over its period (figure 4)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.motions.simulate import steady_orbit
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
motion = steady_orbit(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    job["frequency"],
    # The three numbers under figure 4, and no relative velocity; from rest nothing would collide.
    (1.0, 0.5, 0.0, 0.0),
    samples=4000,
    settling=Settling(**job["settling"]),
)
save(motion, snakemake.output[0])
