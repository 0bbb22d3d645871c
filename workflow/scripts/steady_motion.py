"""A steady motion over its period, reached from rest (figure 4)."""

import sys

import numpy as np

from impact_damper.datasets import save
from impact_damper.ensemble import Settling
from impact_damper.motions import simulate, steady_motion
from impact_damper.parameters import Damper, Oscillator

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
job = snakemake.params.job
case = Oscillator(**job["oscillator"]), Damper(**job["damper"]), job["frequency"]
settling = Settling(**job["settling"])
steady = steady_motion(*case, settling=settling)
motion = simulate(
    *case,
    steady["state"].values,
    periods=int(steady["period"]),
    start=np.pi / (2 * job["frequency"]),
    tolerance=settling.tolerance,
)
save(motion, snakemake.output[0])
