"""Migration control, releases, and the life of the violent transient."""

from impact_damper.data.variables.variable import DAMPED_MOTION, FREE_MOTION, Variable

VARIABLES = {
    # migration control
    "on_time": Variable(("trial", "switching"), "time at which the damper is switched on", "T"),
    "off_time": Variable(("trial", "switching"), "time at which it is switched off", "T"),
    "end_time": Variable(("trial", "switching"), "time at which the free motion has settled", "T"),
    "released_from": Variable(
        ("trial", "switching"), "damped motion when it is switched off", flags=DAMPED_MOTION
    ),
    "released_period": Variable(
        ("trial", "switching"), "its period in forcing periods, 0 if it has not settled", "n"
    ),
    "released_displacement": Variable(
        ("trial", "switching"), "its largest displacement, if it has settled", "max |Z1|"
    ),
    "destination": Variable(
        ("trial", "switching"), "free motion that a release leads to", flags=FREE_MOTION
    ),
    "destination_displacement": Variable(
        ("trial", "switching"), "its largest displacement", "max |Z1|"
    ),
    "trial_outcome": Variable(
        ("trial",),
        "whether a run arrives on the non-resonance branch",
        flags={"not_reached": 0, "reached": 1},
    ),
    "switchings": Variable(("trial",), "times that the damper is switched on in a run"),
    "damper_time": Variable(("trial",), "forcing periods with the damper on"),
    "release_time": Variable(
        ("trial",), "forcing periods from the first switching on to the last switching off"
    ),
    "total_time": Variable(
        ("trial",), "forcing periods from the first switching on to the end of the last free run"
    ),
    "example": Variable((), "run of which the displacement is stored"),
    "bound": Variable(("bound",), "share, or lower or upper end of its 95 % interval"),
    "damped_motion": Variable(("damped_motion",), "kind of damped motion"),
    "free_motion": Variable(("free_motion",), "kind of free motion"),
    "destination_count": Variable(
        ("damped_motion", "free_motion"), "switchings of all runs by where they lead from and to"
    ),
    "reached_share": Variable(("bound",), "runs that arrive on the non-resonance branch"),
    "within_share": Variable(("bound",), "runs that arrive within 350 forcing periods"),
    # releases of each damped motion
    "damped_kind": Variable(("damped",), "kind of damped motion", flags=DAMPED_MOTION),
    "damped_period": Variable(
        ("damped",), "period in forcing periods, 0 if it has not settled", "n"
    ),
    "damped_displacement": Variable(
        ("damped",), "largest displacement, if it has settled", "max |Z1|"
    ),
    "damped_contacts": Variable(
        ("damped",), "contacts begun per forcing period, if it has settled"
    ),
    "release_phase": Variable(
        ("damped", "release"), "forcing periods from Omega T = pi/2 to the release"
    ),
    "release_displacement": Variable(
        ("damped", "release"), "displacement of the primary mass at the release", "Z1"
    ),
    "release_velocity": Variable(
        ("damped", "release"), "velocity of the primary mass at the release", "Z1'"
    ),
    "release_destination": Variable(
        ("damped", "release"), "free motion that the release leads to", flags=FREE_MOTION
    ),
    "release_share": Variable(
        ("damped", "free_motion", "bound"), "releases that lead to each free motion"
    ),
    # life of the violent transient
    "life": Variable(("run",), "forcing periods until a run is captured, if before the horizon"),
    "landing_time": Variable(("run",), "forcing periods until it has settled, if it has"),
    "landed_on": Variable(("run",), "motion on which it settles", flags=DAMPED_MOTION),
    "age": Variable(("age",), "forcing periods since the damper was switched on"),
    "survival": Variable(("age", "bound"), "runs that live longer"),
    "at_risk": Variable(("age",), "number of runs that live longer"),
    "escape_rate": Variable(("bound",), "captures per run and forcing period"),
    "horizon": Variable((), "forcing periods up to which lives are known"),
}
