"""The compared integrators. Each module here lists its integrators in a tuple INTEGRATORS."""

import pkgutil
from functools import cache
from importlib import import_module


@cache
def integrators(stage=None) -> dict:
    """Return the integrators that a stage compares (without a stage: all), as a dict by name."""
    modules = [import_module(f"{__name__}.{each.name}") for each in pkgutil.iter_modules(__path__)]
    declared = [each for module in modules for each in module.INTEGRATORS]
    declared.sort(key=lambda each: each.place)
    return {each.name: each for each in declared if stage is None or stage in each.compared}


@cache
def runs_of_accuracy() -> dict:
    """Return a dict for the stage `accuracy`: label of a run -> (integrator, `locate`)."""
    return {
        each.label(located): (each, located)
        for each in integrators("accuracy").values()
        for located in each.located
    }
