"""Sections on the optimum clearance: sweeps, design rules, and studies over a grid."""

import math
from typing import ClassVar

from chatterjee1995.sections import system
from chatterjee1995.sections.records import Kind, Table, stage
from impact_damper.command.section import (
    dotted,
    increasing,
    number_or_range,
    problem,
    several,
    starts_of,
)
from impact_damper.model.bounds import MOST_RUNS

# Axes of the grid of a study. The cells are counted in this order, the last axis fastest.
AXES = ("mass_ratio", "clearance", "frequency", "restitution")


class Optimum(
    system.keys_of(system.DAMPER, needed=system.NEEDED, without=["clearance", system.COMMON]),
    system.WithOscillator,
):
    """Sweeps of the clearance at one frequency, each with its optimum."""

    frequency: system.FREQUENCY
    clearances: system.range_of(system.CLEARANCE)
    starts: starts_of("at each clearance, in place of `search.sweep_starts`") = None

    @stage(
        "impact_damper.orbits.clearance_sweep:clearance_sweep",
        "Largest displacement against clearance, and its optimum, for all dampers",
        together=True,
        priority=1,
    )
    def optimum(self, config) -> dict:
        sweep = {
            "damper": system.damper_values(self, config),
            "frequency": self.frequency,
            "clearances": self.clearances.even(config.points.clearances),
        }
        search = config.search.job(config, self.starts or config.search.sweep_starts)
        return self.system(config) | sweep | search | config.settling.job()


class DesignRules(system.WithOscillator):
    """Grids of dampers and frequencies on which rules for the clearance are compared."""

    mass_ratios: several(
        system.MASS_RATIO,
        "rm, increasing, at most one for each distinct line style",
        least=1,
        most=5,
    )
    restitutions: several(system.RESTITUTION, "e, increasing", least=1)
    contact_stiffnesses: several(system.CONTACT_STIFFNESS, "r1, increasing", least=1)
    frequencies: several(system.FREQUENCY, "W, increasing, above the linear frequency", least=1)

    counts: ClassVar = ("mass_ratios", "restitutions", "contact_stiffnesses", "frequencies")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        for key in self.counts:
            yield from increasing((*path, key), getattr(self, key), "a grid ascends")
        known = config.oscillators.get(self.oscillator)
        if known and self.frequencies[0] <= known.linear_frequency:
            linear = known.linear_frequency
            reason = f"must lie above the linear frequency {linear!r} (the rules hold above it)"
            yield problem((*path, "frequencies"), self.frequencies, reason)

    @stage(
        "chatterjee1995.stages.design_rules:design_rules",
        "Rules for the clearance against the optimum of the motion, on all grids",
        together=True,
        priority=1,
    )
    def design_rules(self, config) -> dict:
        return self.system(config) | {key: getattr(self, key) for key in self.counts}


def axis(name):
    """Return the type of the parameter `name` in a study: one number, or evenly spaced numbers."""
    several = system.range_of(system.PARAMETERS[name], points=True)
    return number_or_range(
        several, f"{system.MEANINGS[name]}, one value or an even range", **system.BOUNDS[name]
    )


class Study(system.WithOscillator):
    """Outcomes of random starts over a grid of mass ratio, clearance, frequency and restitution."""

    mass_ratio: axis("mass_ratio")
    clearance: axis("clearance")
    frequency: axis("frequency")
    restitution: axis("restitution")

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        cells = self.cells()
        if cells < config.chunks:
            reason = f"must be at most {cells} (the cells of {dotted(path)})"
            yield problem(("chunks",), config.chunks, reason)
        if cells > config.chunks * MOST_RUNS:
            reason = f"must be at least {math.ceil(cells / MOST_RUNS)} with the {cells} cells of "
            reason += f"{dotted(path)} (a job keeps its results in memory, {MOST_RUNS} at most)"
            yield problem(("chunks",), config.chunks, reason)

    def cells(self) -> int:
        return math.prod(points(getattr(self, key)) for key in AXES)

    def chunk(self, config, chunk) -> dict:
        """Return the parameters of the job for one part of the grid, such as `chunk` = "2-of-4"."""
        number, count = map(int, chunk.split("-of-"))
        grid = {
            "axes": {key: even(getattr(self, key)) for key in AXES},
            "cells": [self.cells() * (number - 1) // count, self.cells() * number // count],
            "contact_stiffness": config.contact_stiffness,
        }
        search = config.search.job(config, config.search.study_starts)
        return self.system(config) | grid | search | config.settling.job()

    @stage("chatterjee1995.stages.studies:study_chunk", "The study {name}")
    def studies(self, config) -> dict:
        """Return {}: the job that joins the parts of the grid has no parameters."""
        return {}


def points(given) -> int:
    """Return how many points an axis has. `given` is a number (one point) or a range."""
    return getattr(given, "points", 1)


def even(given) -> dict:
    """Return what a job needs to make an axis. If `given` is a number, the axis has one point."""
    return given.even() if hasattr(given, "even") else {"linspace": [given, given, 1]}


SECTIONS = {"optimum": Optimum, "design_rules": DesignRules, "studies": Study}
KINDS = (
    Kind("optimum", "clearance", "clearance", ("optimum",)),
    Kind("design_rules", "clearance", "clearance", ("design_rules",)),
    Kind("studies", "clearance", "clearance", ("studies",), most=1),
)
TABLES = (
    Table("optimum", "clearance", "clearance", ("optimum",)),
    Table("design_rules", "clearance", "clearance", ("design_rules", "optimum")),
)
