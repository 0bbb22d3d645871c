"""Sections on responses: curves over frequency, steady motions, and shares of collisions."""

from chatterjee1995.sections import system
from chatterjee1995.sections.records import Kind, Table, stage
from impact_damper.command.section import choice, dotted, problem, several

STAGES_OF_CURVES = ("harmonic_balance", "design_orbit", "response", "subharmonic", "branches")
NEED_DAMPER = ("design_orbit", "subharmonic")  # stages that only curves with a damper can list
# Initial state Z1, Z1', Z2, Z2'. Figure 4 of the paper gives three numbers; Z2' = 0 is our choice.
START = [1.0, 0.5, 0.0, 0.0]


class Curve(system.MaybeWithDamper):
    """Response curves over frequency, of an oscillator with or without a damper."""

    clearance: system.CLEARANCE_OR_RULE = None
    stages: several(
        choice("", *STAGES_OF_CURVES), "stages to compute for the curve", least=1, distinct=True
    )

    def contradictions(self, path, config):
        yield from super().contradictions(path, config)
        starts, stages = config.search.starts, (*path, "stages")
        if "subharmonic" in self.stages and starts < 2:
            reason = f"must be at least 2 with {dotted(stages)} subharmonic (half are switched on)"
            yield problem(("search", "starts"), starts, reason)
        if "branches" in self.stages and "response" not in self.stages:
            reason = "must hold response with branches (orbits are followed from the motions found)"
            yield problem(stages, self.stages, reason)
        if not self.has_damper():
            for stage in sorted(set(NEED_DAMPER) & set(self.stages)):
                reason = f"must not hold {stage} without a damper (mass_ratio and so on)"
                yield problem(stages, self.stages, reason)
        if "harmonic_balance" in self.stages and self.restitution not in (None, 1):
            reason = "must be 1 with the stage harmonic_balance (it knows elastic contact only)"
            yield problem((*path, "restitution"), self.restitution, reason)
        if self.clearance == "rule" and set(self.stages) - {"harmonic_balance", "design_orbit"}:
            reason = "must be a number with stages other than harmonic_balance and design_orbit"
            reason = f"{reason} (see table harmonic_balance)"
            yield problem((*path, "clearance"), self.clearance, reason)
        if self.clearance == "rule" and self.oscillator in config.oscillators and self.has_damper():
            try:
                self.system(config)
            except ValueError as error:
                reason = f"must be a number with the oscillator {self.oscillator} ({error})"
                yield problem((*path, "clearance"), self.clearance, reason)

    def span(self, config):
        return config.oscillators[self.oscillator].frequencies

    @stage(
        "impact_damper.theory.harmonic_balance:harmonic_balance",
        "Harmonic balance of all curves",
        together=True,
        priority=1,
    )
    def harmonic_balance(self, config) -> dict:
        points = config.points.harmonic_balance
        return self.system(config) | {"frequencies": self.span(config).even(points)}

    @stage(
        "chatterjee1995.stages.design_orbit:design_orbit",
        "Exact quiet orbits at the design points of curves",
        together=True,
    )
    def design_orbit(self, config) -> dict:
        search = config.search.job(config, config.search.sweep_starts)
        return self.system(config) | search | config.settling.job()

    @stage(
        "chatterjee1995.stages.subharmonic:subharmonic_suppression",
        "Runs from the one-third subharmonic, for the curve {name}",
        priority=2,
    )
    def subharmonic(self, config) -> dict:
        points = config.points.simulated if self.has_damper() else config.points.free
        frequencies = {"frequencies": self.span(config).even(points)}
        search = config.search.job(config, config.search.starts)
        return self.system(config) | frequencies | search | config.settling.job()

    @stage(
        "impact_damper.motions.response:frequency_response",
        "Motions over frequency, of the curve {name}",
        priority=2,
    )
    def response(self, config) -> dict:
        lives = {key: getattr(config.search, key) for key in ("life_runs", "life_periods")}
        return self.subharmonic(config) | lives

    @stage(
        "impact_damper.orbits.orbit_branches:orbit_branches",
        "Branches of periodic orbits of the curve {name}",
        reads={"motions": ("response", "subharmonic")},
        priority=1,
    )
    def branches(self, config) -> dict:
        span = self.span(config)
        return self.system(config) | {"span": [span.first, span.last]}


class Motion(system.WithDamper):
    """Steady motions at one frequency."""

    frequency: system.FREQUENCY

    @stage("impact_damper.motions.steady:steady_orbit", "Steady motion {name}")
    def motion(self, config) -> dict:
        run = {"frequency": self.frequency, "state": START, "samples": 4000}
        return self.system(config) | run | config.settling.job()


class Collision(system.WithDamper):
    """Shares of random starts that lead to a collision; some starts lie beyond the walls."""

    frequency: system.FREQUENCY

    @stage(
        "chatterjee1995.stages.collisions:collisions",
        "Starts that lead to collisions",
        together=True,
    )
    def collisions(self, config) -> dict:
        drawn = {"radius": config.search.radius, "seed": config.seed}
        return self.system(config) | {"frequency": self.frequency} | drawn


SECTIONS = {"curves": Curve, "motion": Motion, "collisions": Collision}
KINDS = (
    Kind("harmonic_balance", "design", "responses", ("harmonic_balance",)),
    Kind("free", "responses", "responses", ("branches",), damper=False),
    Kind("motion", "responses", "responses", ("motion",)),
    Kind(
        "response",
        "responses",
        "responses",
        ("response", "harmonic_balance", "subharmonic", "branches"),
    ),
    Kind("branches", "responses", "responses", ("branches",)),
    Kind("shares", "responses", "responses", ("response",)),
)
TABLES = (
    Table("harmonic_balance", "design", "balance", ("harmonic_balance", "design_orbit")),
    Table(
        "outcomes",
        "responses",
        "responses",
        ("response", "subharmonic", "optimum", "studies", "balance_map"),
    ),
    Table("quasi_periodic", "responses", "responses", ("response",)),
    Table("chaos", "responses", "responses", ("response", "branches")),
    Table("subharmonic", "responses", "responses", ("branches", "subharmonic")),
    Table("orbits", "responses", "branches", ("branches",)),
    Table("bifurcations", "responses", "branches", ("branches",)),
)
