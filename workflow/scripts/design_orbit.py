"""The true quiet orbit at the peak frequency, followed in damping (figure 3)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.design_orbit import design_orbit
from impact_damper.stages.harmonic_balance import optimum_clearance
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
oscillator = Oscillator(**job["oscillator"])
given = job["damper"]
if given["clearance"] == "rule":
    given = given | {"clearance": optimum_clearance(oscillator, given["mass_ratio"])}
orbit = design_orbit(
    oscillator, Damper(**given), **job["search"], settling=Settling(**job["settling"])
)
save(orbit, snakemake.output[0])
