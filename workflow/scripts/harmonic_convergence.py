"""Harmonic balance with more and more harmonics, compared with the exact orbit."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.harmonic_convergence import harmonic_convergence, ladder

job = Job(snakemake)
harmonics = ladder(job["highest"])
cold = harmonics[harmonics <= job["highest_cold"]].tolist()
job.save(harmonic_convergence(job.oscillator, job.damper, job["frequency"], harmonics, cold=cold))
