"""Harmonic balance with many harmonics against the exact orbit."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.data.datasets import save
from impact_damper.stages.harmonic_convergence import harmonic_convergence, ladder
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
harmonics = ladder(job["highest"])
convergence = harmonic_convergence(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]) if job["damper"] else None,
    job["frequency"],
    harmonics,
    cold=harmonics[harmonics <= job["highest_cold"]].tolist(),
)
save(convergence, snakemake.output[0])
