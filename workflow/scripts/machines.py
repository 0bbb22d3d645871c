"""A machine with its damper in SI units: over the frequency, and at one over the gap."""

import numpy as np

from impact_damper.workflow.job import Job
from impact_damper.machine.machine import Machine
from impact_damper.machine.units import si_value
from impact_damper.stages.machines import machine_study

job = Job(snakemake)


def grid(key, quantity):
    """Evenly spaced values between two that may be texts with units."""
    first, last, count = job[key]
    return np.linspace(si_value(key, first, quantity), si_value(key, last, quantity), count)


machine = Machine(**job["machine"])
job.save(
    machine_study(
        machine,
        machine.damper(**job["damper"]),
        grid("frequencies", "frequency"),
        si_value("frequency", job["frequency"], "frequency"),
        grid("gaps", "clearance"),
        starts=job["starts"],
        seed=job["seed"],
        settling=job.settling,
        **job.running,
    )
)
