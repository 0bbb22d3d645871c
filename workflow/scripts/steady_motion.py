"""A steady motion over its period (figure 4)."""

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
# The three numbers under figure 4, and no relative velocity; from rest nothing would collide.
steady = steady_motion(*case, (1.0, 0.5, 0.0, 0.0), settling=settling)
motion = simulate(
    *case,
    steady["state"].values,
    periods=int(steady["period"]),
    samples=4000,
    start=np.pi / (2 * job["frequency"]),
    tolerance=settling.tolerance,
)
save(motion, snakemake.output[0])
