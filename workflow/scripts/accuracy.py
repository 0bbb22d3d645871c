"""Errors of integrators and models over floating-point operations, on a scene (test case)."""

import json
from pathlib import Path

from chatterjee1995.workflow.job import Job
from chatterjee1995.methods.accuracy import ComparisonScene, error_against_work

job = Job(snakemake)
references = json.loads(Path(snakemake.input.references).read_text())
keys = ("name", "frequency", "state", "periods", "motion", "accuracy")
scene = ComparisonScene(
    oscillator=job.oscillator, damper=job.damper, **{key: job[key] for key in keys}
)
job.save(error_against_work(scene, job["settings"], references.get(scene.name)))
