"""Sections on migration control (switching the damper to change the motion) and on basins."""

from chatterjee1995.sections import system
from chatterjee1995.sections.records import Kind, Table, stage
from impact_damper.command.section import count, entries, increasing, number, several
from impact_damper.model.bounds import FARTHEST, FASTEST, LIFETIME_RANGE, PERIODS_RANGE, RUNS_RANGE


class Migration(system.WithDamper):
    """Cases of migration control."""

    frequency: system.FREQUENCY
    longest_hold: count(
        "forcing cycles after which the damper is switched off at the latest", **PERIODS_RANGE
    )

    @stage(
        "chatterjee1995.stages.releases:migration", "Migration control, the case {name}", priority=1
    )
    def migration(self, config) -> dict:
        run = {"frequency": self.frequency, "longest_hold": self.longest_hold, "seed": config.seed}
        return self.system(config) | dict(config.controller) | run | config.settling.job()


class ReleaseScan(system.WithDamper):
    """Motions to which the oscillator settles after the damper is switched off (release)."""

    frequencies: system.FREQUENCIES
    lifetime: count(
        "forcing cycles within which motions that have not settled are released",
        **LIFETIME_RANGE | {"least": 40},
    )

    @stage(
        "chatterjee1995.stages.releases:release_scan",
        "Motions after the damper is switched off, over frequency, the scan {name}",
    )
    def release_scan(self, config) -> dict:
        scan = {
            "frequencies": self.frequencies.even(config.points.scanned),
            "releases": config.controller.releases,
            "lifetime": self.lifetime,
        }
        search = config.search.job(config, config.search.scan_starts)
        return self.system(config) | scan | search | config.settling.job()


class Basins(system.MaybeWithDamper):
    """Planes of states of the primary mass, and the motions to which the states lead."""

    frequency: system.FREQUENCY
    displacement: number("half width of the plane in Z1", above=0, most=FARTHEST)
    velocity: number("half width of the plane in Z1'", above=0, most=FASTEST)
    cells: count("states on each axis of the plane", least=2, most=10**4)

    @stage(
        "impact_damper.orbits.basins:basins",
        "Motions to which the states of a plane lead, the plane {name}",
    )
    def basins(self, config) -> dict:
        plane = system.given(self, ["frequency", "displacement", "velocity", "cells"])
        return self.system(config) | plane | config.settling.job()


class ReleasePolicies(system.WithOscillator):
    """Policies of migration (rules for the release) for several dampers, over frequency."""

    dampers: entries(system.keys_of(system.DAMPER, needed=system.NEEDED, without=[system.COMMON]))
    frequencies: several(system.FREQUENCY, "increasing forcing frequencies", least=1, distinct=True)
    trials: count("trials of each policy", **RUNS_RANGE)
    cells: count("cells on each axis of the coarse grid of a basin", least=4, most=4096)

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        yield from increasing((*path, "frequencies"), self.frequencies, "frequencies of a curve")

    @stage(
        "chatterjee1995.stages.release_policies:release_policies",
        "Policies of migration, the dampers {name}",
        priority=1,
    )
    def release_policies(self, config) -> dict:
        dampers = [each for _, each in sorted(self.dampers.items())]
        values = {"dampers": [{"Damper": system.damper_values(each, config)} for each in dampers]}
        values |= system.given(self, ["frequencies", "trials", "cells"])
        return self.system(config) | values | {"seed": config.seed} | config.settling.job()


SECTIONS = {
    "migration": Migration,
    "release_scan": ReleaseScan,
    "basins": Basins,
    "release_policies": ReleasePolicies,
}
KINDS = (
    Kind("migration", "migration", "migration", ("migration",)),
    Kind("release", "migration", "migration", ("migration",)),
    Kind("basins", "migration", "migration", ("basins",), damper=False, most=4),
    Kind("release_policies", "migration", "migration", ("release_policies",), most=1),
)
TABLES = (
    Table("migration", "migration", "migration", ("migration",)),
    Table("release_scan", "migration", "migration", ("release_scan",)),
    Table("release_policies", "migration", "migration", ("release_policies",)),
)
