"""Registers the variables of all stages of the paper, so that tests can invent datasets."""

import pkgutil
from importlib import import_module

from chatterjee1995 import methods, stages

for package in (methods, stages):
    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        import_module(module.name)
