"""Migration control, releases of damped motions, and the lifetime of the violent transient.

The controller of figure 17 switches the damper on and off (one switching) until the free motion is
the non-resonance motion. One run of the controller is a trial. A damped motion is a motion with the
damper on; its release is the moment at which the damper is switched off. A violent transient is the
large motion that may follow when the damper is switched on.
"""

from impact_damper.data.variables.variable import DAMPED_MOTION, FREE_MOTION, Variable

VARIABLES = {
    # migration control
    "on_time": Variable(
        ("trial", "switching"), "time at which the damper is switched on", "T", quantity="time"
    ),
    "off_time": Variable(
        ("trial", "switching"), "time at which the damper is switched off", "T", quantity="time"
    ),
    "end_time": Variable(
        ("trial", "switching"), "time at which the free motion has settled", "T", quantity="time"
    ),
    "released_from": Variable(
        ("trial", "switching"),
        "damped motion in which the damper is switched off",
        flags=DAMPED_MOTION,
    ),
    "released_period": Variable(
        ("trial", "switching"),
        "period in cycles of the motion released_from, 0 if it has not settled",
        "n",
    ),
    "released_displacement": Variable(
        ("trial", "switching"),
        "largest displacement of the motion released_from, if it has settled",
        "max |Z1|",
        quantity="displacement",
    ),
    "destination": Variable(
        ("trial", "switching"), "free motion to which a release leads", flags=FREE_MOTION
    ),
    "destination_displacement": Variable(
        ("trial", "switching"),
        "largest displacement of the free motion",
        "max |Z1|",
        quantity="displacement",
    ),
    "trial_outcome": Variable(
        ("trial",),
        "whether a run arrives on the non-resonance branch",
        flags={"not_reached": 0, "reached": 1},
    ),
    "switchings": Variable(("trial",), "number of times that the damper is switched on in a run"),
    "damper_time": Variable(("trial",), "cycles with the damper on"),
    "release_time": Variable(
        ("trial",), "cycles from first switching the damper on to last switching it off"
    ),
    "total_time": Variable(
        ("trial",),
        "cycles from first switching the damper on to the end of the last free run",
    ),
    "example": Variable((), "index of the run whose displacement is stored"),
    "bound": Variable(("bound",), "share, or lower or upper end of its 95 % interval"),
    "damped_motion": Variable(("damped_motion",), "kind of damped motion"),
    "free_motion": Variable(("free_motion",), "kind of free motion"),
    "destination_count": Variable(
        ("damped_motion", "free_motion"),
        "number of releases in all runs, by the damped motion before and the free motion after",
    ),
    "reached_share": Variable(("bound",), "share of runs that arrive on the non-resonance branch"),
    "within_share": Variable(("bound",), "share of runs that arrive within 350 cycles"),
    # releases of each damped motion
    "damped_kind": Variable(("damped",), "kind of damped motion", flags=DAMPED_MOTION),
    "damped_period": Variable(("damped",), "period in cycles, 0 if it has not settled", "n"),
    "damped_displacement": Variable(
        ("damped",),
        "largest displacement, if the motion has settled",
        "max |Z1|",
        quantity="displacement",
    ),
    "damped_contacts": Variable(("damped",), "contacts begun per cycle, if the motion has settled"),
    "release_phase": Variable(("damped", "release"), "cycles from Omega T = pi/2 to the release"),
    "release_displacement": Variable(
        ("damped", "release"),
        "displacement of the primary mass at the release",
        "Z1",
        quantity="displacement",
    ),
    "release_velocity": Variable(
        ("damped", "release"),
        "velocity of the primary mass at the release",
        "Z1'",
        quantity="velocity",
    ),
    "release_destination": Variable(
        ("damped", "release"), "free motion to which the release leads", flags=FREE_MOTION
    ),
    "release_share": Variable(
        ("damped", "free_motion", "bound"), "share of releases that lead to each free motion"
    ),
    # lifetime of the violent transient
    "life": Variable(
        ("run",),
        "cycles until the violent transient ends, if it ends before the time horizon",
    ),
    "landing_time": Variable(("run",), "cycles until the motion has settled; NaN if it has not"),
    "landed_on": Variable(("run",), "motion on which the run settles", flags=DAMPED_MOTION),
    "age": Variable(("age",), "cycles since the damper was switched on"),
    "survival": Variable(("age", "bound"), "share of runs whose transient is longer than age"),
    "at_risk": Variable(("age",), "number of runs whose transient is longer than age"),
    "escape_rate": Variable(("bound",), "rate at which transients end, per run and cycle"),
    "horizon": Variable((), "cycles after which a run is cut off"),
}
