"""Migration control, releases of damped motions, and the lifetime of the violent transient."""

from impact_damper.data.variables.variable import DAMPED_MOTION, FREE_MOTION, Variable

VARIABLES = {
    # migration control
    "on_time": Variable(("trial", "switching"), "time at which the damper is switched on", "T"),
    "off_time": Variable(("trial", "switching"), "time at which the damper is switched off", "T"),
    "end_time": Variable(("trial", "switching"), "time at which the free motion has settled", "T"),
    "released_from": Variable(
        ("trial", "switching"), "damped motion when it is switched off", flags=DAMPED_MOTION
    ),
    "released_period": Variable(
        ("trial", "switching"), "period of released_from in forcing periods, 0 if not settled", "n"
    ),
    "released_displacement": Variable(
        ("trial", "switching"), "largest displacement of released_from, if settled", "max |Z1|"
    ),
    "destination": Variable(
        ("trial", "switching"), "free motion that a release leads to", flags=FREE_MOTION
    ),
    "destination_displacement": Variable(
        ("trial", "switching"), "largest displacement of the free motion", "max |Z1|"
    ),
    "trial_outcome": Variable(
        ("trial",),
        "whether a run arrives on the non-resonance branch",
        flags={"not_reached": 0, "reached": 1},
    ),
    "switchings": Variable(("trial",), "number of times that the damper is switched on in a run"),
    "damper_time": Variable(("trial",), "forcing periods with the damper on"),
    "release_time": Variable(
        ("trial",), "forcing periods from the first switching on to the last switching off"
    ),
    "total_time": Variable(
        ("trial",), "forcing periods from the first switching on to the end of the last free run"
    ),
    "example": Variable((), "number of the run whose displacement is stored"),
    "bound": Variable(("bound",), "share, or lower or upper end of its 95 % interval"),
    "damped_motion": Variable(("damped_motion",), "kind of damped motion"),
    "free_motion": Variable(("free_motion",), "kind of free motion"),
    "destination_count": Variable(
        ("damped_motion", "free_motion"),
        "number of switchings of all runs, by damped and by free motion",
    ),
    "reached_share": Variable(("bound",), "share of runs that arrive on the non-resonance branch"),
    "within_share": Variable(("bound",), "share of runs that arrive within 350 forcing periods"),
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
        ("damped", "free_motion", "bound"), "share of releases that lead to each free motion"
    ),
    # lifetime of the violent transient
    "life": Variable(
        ("run",), "forcing periods until the violent transient ends, if before the horizon"
    ),
    "landing_time": Variable(("run",), "forcing periods until the run has settled, if settled"),
    "landed_on": Variable(("run",), "motion on which the run settles", flags=DAMPED_MOTION),
    "age": Variable(("age",), "forcing periods since the damper was switched on"),
    "survival": Variable(("age", "bound"), "share of runs whose transient lasts longer than age"),
    "at_risk": Variable(("age",), "number of runs whose transient lasts longer than age"),
    "escape_rate": Variable(("bound",), "rate at which transients end, per run and forcing period"),
    "horizon": Variable((), "forcing periods after which a run is cut off"),
}
