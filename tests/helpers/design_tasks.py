"""Design tasks of a small linear machine, and the mark of tests that compile a C program."""

import shutil
from dataclasses import fields

import pytest

import impact_damper as idm
from impact_damper.design.task import Effort, Task

MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
needs_compiler = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler `cc`")
EFFORT = {each.name for each in fields(Effort)}


def task(**changed):
    """Return a task. `changed` holds arguments of `Task` and of `Effort`."""
    given = {"machine": MACHINE, "mass": 0.6, "band": (20.3, 20.8), "restitution": 0.7}
    given |= {"contact": 2e7} | changed
    effort = {name: given.pop(name) for name in EFFORT & given.keys()}
    return Task(**given, effort=Effort(**effort))
