"""Settings of many stages: grids, searches, settling, and the controller."""

from impact_damper.command.messages import problem
from impact_damper.command.section import Section
from impact_damper.command.values import count, number, points_of, starts_of, text
from impact_damper.model.bounds import (
    FURTHER_RANGE,
    LIFETIME_RANGE,
    LIMIT_RANGE,
    PATIENCE_RANGE,
    PERIODS_RANGE,
    RADIUS_RANGE,
    RUNS_RANGE,
    SEED_RANGE,
    TOLERANCE_RANGE,
    WATCHED_RANGE,
)

SEED = count("seed of all random draws", **SEED_RANGE)
RESULTS = text(
    "folder below the working directory, without spaces or leading dots",
    pattern="[A-Za-z0-9_][A-Za-z0-9_.-]*(/[A-Za-z0-9_][A-Za-z0-9_.-]*)*",
)
RADIUS = number("radius of the ball from which random starts are drawn", **RADIUS_RANGE)


class Points(Section):
    """Numbers of points of grids."""

    harmonic_balance: points_of("frequencies at which equations of harmonic balance are solved")
    free: points_of("frequencies of simulated motions without a damper")
    simulated: points_of("frequencies of simulated motions with a damper")
    clearances: points_of("clearances of the sweep for an optimum")
    scanned: points_of("frequencies of a release scan")
    map_frequencies: points_of("frequencies of a map of harmonic balance")
    map_values: points_of("values of the other parameter of a map of harmonic balance")


class Search(Section):
    """Random starts (initial states) from which motions are searched for."""

    starts: starts_of("at each frequency of a response")
    sweep_starts: starts_of("at each clearance of the sweep for an optimum")
    scan_starts: starts_of("at each frequency of a release scan")
    study_starts: starts_of("in each cell of a study")
    radius: RADIUS
    life_runs: count("runs that measure how long a chaotic motion lasts", least=0, most=1000)
    life_periods: count("forcing cycles of the runs `life_runs`", **LIFETIME_RANGE)


class Settling(Section):
    """Length and tolerance of runs."""

    tolerance: number("local error allowed in a step of the integrator", **TOLERANCE_RANGE)
    patience: count(
        "forcing cycles after which a motion that is certainly chaotic is stopped",
        **PATIENCE_RANGE,
    )
    limit: count("forcing cycles after which every other motion is stopped", **LIMIT_RANGE)
    further: count(
        "largest number of forcing cycles for which an undecided motion is continued",
        **FURTHER_RANGE,
    )
    watched: count(
        "forcing cycles over which a motion that has not settled is measured", **WATCHED_RANGE
    )

    def contradictions(self, path, config):
        if self.limit < self.patience:
            reason = f"must be at least settling.patience = {self.patience} (it comes later)"
            yield problem((*path, "limit"), self.limit, reason)


class Controller(Section):
    """The migration controller, which switches the damper (the paper's figure 17), and its runs."""

    trials: count("runs of each case", **RUNS_RANGE)
    periods: count("forcing cycles of a run after which no switching begins", **PERIODS_RANGE)
    releases: count(
        "releases of each motion with damper, and number of long runs that measure lifetimes",
        **RUNS_RANGE,
    )
    lifetime: count("forcing cycles of the long runs", **LIFETIME_RANGE)
