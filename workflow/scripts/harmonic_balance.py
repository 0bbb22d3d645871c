"""Response by harmonic balance, and suppression band (paper: section 2, figures 2, 3, 5, 8).

The suppression band is the range of frequencies without violent (large) motion.
"""

from chatterjee1995.workflow.job import Job
from impact_damper.theory.harmonic_balance import harmonic_balance

job = Job(snakemake)
job.save(harmonic_balance(job.oscillator, job.damper, job.grid("frequencies")))
