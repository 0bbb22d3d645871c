"""An impact damper designed for a machine.

Finished steps of the design are kept in a folder until the design is saved, so that an interrupted
job continues.
"""

import shutil
from pathlib import Path

from chatterjee1995.workflow.job import Job
from impact_damper.design.design_damper import design_damper
from impact_damper.model.hertz import HertzContact
from impact_damper.model.machine import Machine

job = Job(snakemake)
steps = Path(job.output).with_suffix("") / "steps"
ball = job["contact"]
kept = ("band", "frequencies", "candidates", "starts", "share", "tolerances", "displacement_limit")
found = design_damper(
    Machine(**job["machine"]),
    **job["damper"],
    **{key: job[key] for key in kept},
    contact=HertzContact.of_ball(**ball) if ball else None,
    seed=job["seed"],
    settling=job.settling,
    folder=steps,
    **job.running,
)
job.save(found.assign_attrs(name=Path(job.output).stem))
shutil.rmtree(steps)
