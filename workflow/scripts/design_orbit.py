"""The true quiet orbit at the peak frequency, followed in damping (figure 3)."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.datasets import save
from impact_damper.design import optimum_clearance
from impact_damper.design_orbit import design_orbit
from impact_damper.ensemble import Settling
from impact_damper.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
oscillator = Oscillator(**job["oscillator"])
given = job["damper"]
if given["clearance"] == "rule":
    given = given | {"clearance": optimum_clearance(oscillator, given["mass_ratio"])}
orbit = design_orbit(
    oscillator, Damper(**given), **job["search"], settling=Settling(**job["settling"])
)
save(orbit, snakemake.output[0])
