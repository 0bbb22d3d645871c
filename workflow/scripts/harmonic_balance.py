"""Response by harmonic balance, and suppression band (section 2, figures 2, 3, 5 and 8)."""

from impact_damper.workflow.job import Job
from impact_damper.stages.harmonic_balance import harmonic_balance

job = Job(snakemake)
job.save(harmonic_balance(job.oscillator, job.damper, job.grid("frequencies")))
