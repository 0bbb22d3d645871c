"""Design tasks of a small linear machine, and made-up comparisons of gaps."""

from dataclasses import fields

import numpy as np

import impact_damper as idm
from impact_damper.design.task import SIDES, Effort, Task, labelled

MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
EFFORT = {each.name for each in fields(Effort)}


def task(**changed):
    """Return a task; arguments of `Effort` stand beside those of `Task`."""
    given = {"machine": MACHINE, "mass": 0.6, "band": (20.3, 20.8), "restitution": 0.7}
    given |= {"contact": 2e7} | changed
    effort = {name: given.pop(name) for name in EFFORT & given.keys()}
    return Task(**given, effort=Effort(**effort))


def compared(gaps, shares, worst, limit=2.0):
    """Return a comparison of gaps; the lower end of an interval is .04 below the share."""
    shares, worst = np.asarray(shares, float), np.asarray(worst, float)
    values = {
        "start_quiet_share": shares,
        "start_quiet_interval": np.stack([shares - 0.04, shares], axis=-1),
        "worst_displacement": worst,
        "displacement_limit": limit,
    }
    frequencies = 20.0 + np.arange(shares.shape[1])
    return labelled(values, candidate_gap=np.asarray(gaps), frequency=frequencies, side=SIDES)
