"""Verdicts on integrators by tolerance: do they find the right motion near known orbits?"""

from chatterjee1995.workflow.job import Job
from chatterjee1995.methods.method_verdicts import make_scene, verdicts
from impact_damper.model.parameters import Damper

job = Job(snakemake)
scenes = {}
for name, given in job["scenes"].items():
    damper = given.pop("damper")
    damper = None if damper is None else Damper(**damper)
    scenes[name] = make_scene(job.oscillator, damper, **given)
job.save(verdicts(scenes, job.powers("tolerances"), job.counts("steps")))
