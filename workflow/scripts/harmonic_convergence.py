"""Harmonic balance with many harmonics against the exact orbit."""

import sys
from collections import ChainMap

from impact_damper.datasets import save
from impact_damper.harmonics import harmonic_convergence, ladder
from impact_damper.parameters import Damper, Oscillator

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
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
