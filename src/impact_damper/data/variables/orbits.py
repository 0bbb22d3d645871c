"""Exact periodic orbits, their branches and bifurcations."""

from impact_damper.data.variables.variable import OUTCOME, STABILITY, Variable

EVENT = {
    "fold": 1,
    "symmetry_breaking": 2,
    "period_doubling": 3,
    "neimark_sacker": 4,
    "grazing": 5,
    "merging": 6,
}
BRANCH_END = {
    "range_ends": 0,
    "closed": 1,
    "symmetry_breaking": 2,
    "period_doubling": 3,
    "contact_lost": 4,
    "lost": 5,
    "point_limit": 6,
    "unstable": 7,
}
OTHER = {
    "absent": 0,
    "followed": 1,
    "ended": 2,
    "not_followed": 3,
    "not_passed": 4,
    "not_found": 5,
}
SIDE = {"absent": 0, "supercritical": 1, "subcritical": 2, "beside_grazing": 3, "undecided": 4}
TORUS = {"absent": 0, "stable": 1, "unstable": 2, "of_unstable_orbit": 3, "unknown": 4}

VARIABLES = {
    # orbits along branches
    "followed_value": Variable(
        ("point",),
        "value of the parameter that is varied along a branch of orbits",
        quantity="followed",
    ),
    "orbit_branch": Variable(("point",), "number of the branch an orbit lies on"),
    "orbit_displacement": Variable(
        ("point",), "largest displacement in an orbit", "max |Z1|", quantity="displacement"
    ),
    "orbit_stability": Variable(
        ("point",), "whether all Floquet multipliers are less than 1 in modulus", flags=STABILITY
    ),
    "orbit_status": Variable(
        ("point",),
        "whether Newton's method converged; near grazing a contact begins so slowly that the "
        "multipliers hold for infinitesimal disturbances only",
        flags={"not_converged": 0, "regular": 1, "near_grazing": 2},
    ),
    "orbit_contacts": Variable(("point",), "contacts begun per cycle in an orbit"),
    "orbit_asymmetry": Variable(
        ("point",),
        "distance of an orbit from its mirror image half a period later",
        quantity="mixed",
    ),
    "orbit_amplitude": Variable(
        ("point",),
        "amplitude of the first harmonic of Z1 in an orbit, |a| of harmonic balance",
        quantity="displacement",
    ),
    "orbit_phase_relative": Variable(
        ("point",), "phase of Z1 to Z2 in an orbit, first harmonics", units="radian"
    ),
    "orbit_phase_loose": Variable(
        ("point",), "phase of Z1 to Z1 - Z2 in an orbit, first harmonics", units="radian"
    ),
    "orbit_phase": Variable(("point",), "phase Omega T of orbit_state", "", "radian"),
    "orbit_state": Variable(
        ("point", "component"),
        "state of an orbit at orbit_phase, without contact",
        quantity="state",
    ),
    "orbit_residual": Variable(
        ("point",),
        "distance between the state of an orbit and the state a period later",
        quantity="mixed",
    ),
    "orbit_multiplier_real": Variable(
        ("point", "multiplier"), "Floquet multipliers by descending modulus, real part"
    ),
    "orbit_multiplier_imaginary": Variable(
        ("point", "multiplier"), "Floquet multipliers by descending modulus, imaginary part"
    ),
    "liouville_error": Variable(
        ("point",), "relative error of the determinant of the monodromy matrix"
    ),
    "least_speed": Variable(
        ("point",),
        "smallest relative speed at the beginning of a contact of an orbit",
        quantity="velocity",
    ),
    "orbit_restitution": Variable(
        ("point",), "smallest ratio of the relative speeds after and before a contact of an orbit"
    ),
    # design points
    "design_orbit_status": Variable(
        (),
        "whether the quiet orbit was found at heavy damping and followed to the design point",
        flags={"no_start": 0, "found": 1, "not_followed": 2},
    ),
    "design_run_outcome": Variable(
        ("design_start",), "outcome of a random start at the design point", flags=OUTCOME
    ),
    "design_run_displacement": Variable(
        ("design_start",),
        "largest displacement of the motion from a random start",
        "max |Z1|",
        quantity="displacement",
    ),
    # branches
    "branch_period": Variable(("branch",), "period in cycles of the orbits", "n"),
    "branch_events_lost": Variable(
        ("branch",), "number of events on a branch that were not located"
    ),
    "branch_end": Variable(
        ("branch", "edge"), "event or limit that ends a branch", flags=BRANCH_END
    ),
    "branch_met": Variable(
        ("branch", "edge"),
        "number of the branch at which a branch ends by symmetry breaking or period doubling; -1 "
        "if this branch is not in the dataset, or if the branch ends otherwise",
    ),
    "seeds": Variable((), "number of motions from which Newton's method searched for an orbit"),
    "seeds_lost": Variable(
        (), "number of motions from which Newton's method converged to no orbit"
    ),
    "searches": Variable(
        (), "number of searches by Newton's method, from random states, for orbits of period 1 to 3"
    ),
    "searches_stable": Variable((), "number of searches that found a stable orbit"),
    "searches_new": Variable(
        (),
        "number of branches followed from orbits that searches found and no other branch held",
    ),
    # events
    "event_branch": Variable(("event",), "branch on which an event lies"),
    "event_place": Variable(("event",), "index along the branch of the orbit at an event"),
    "event_kind": Variable(("event",), "kind of event", flags=EVENT),
    "event_value": Variable(("event",), "varied parameter at an event", quantity="followed"),
    "event_displacement": Variable(
        ("event",), "largest displacement at an event", "max |Z1|", quantity="displacement"
    ),
    "event_residual": Variable(
        ("event",),
        "distance between the state of the orbit at an event and the state a period later",
        quantity="mixed",
    ),
    "event_speed": Variable(
        ("event",),
        "smallest relative speed at the beginning of a contact at an event",
        quantity="velocity",
    ),
    "walls_before": Variable(
        ("event",), "walls in the order in which orbits before an event touch them"
    ),
    "walls_after": Variable(
        ("event",), "walls in the order in which orbits after an event touch them"
    ),
    # branches that leave at losses of symmetry and period doublings
    "leaving_outcome": Variable(
        ("event",),
        "what became of the other branch, which leaves at a loss of symmetry or period doubling. "
        "followed: it is in the dataset; ended: the branch of the event ends at it; not_followed: "
        "one of its orbits was found, but its period is too long; not_passed: it was not followed "
        "past a grazing; not_found: none of its orbits was found",
        flags=OTHER,
    ),
    "leaving_branch": Variable(
        ("event",), "number of the other branch at an event, -1 if it is not in the dataset"
    ),
    "leaving_value": Variable(
        ("event",),
        "varied parameter of the orbit of the other branch that was found close to an event",
        quantity="followed",
    ),
    "leaving_displacement": Variable(
        ("event",),
        "largest displacement of the orbit of the other branch found close to an event",
        "max |Z1|",
        quantity="displacement",
    ),
    "leaving_stability": Variable(
        ("event",),
        "stability of the orbit of the other branch found close to an event",
        flags=STABILITY,
    ),
    "leaving_side": Variable(
        ("event",),
        "whether the other branch begins supercritical, with as many unstable multipliers as the "
        "first branch on its more stable side, or subcritical, with one more; not determined near "
        "a grazing, where multipliers change too fast",
        flags=SIDE,
    ),
    # tori that begin at Neimark-Sacker points
    "torus_kind": Variable(
        ("event",),
        "torus that begins at a Neimark-Sacker point: stable, unstable, around an orbit with "
        "another multiplier outside the unit circle, or undecided",
        flags=TORUS,
    ),
    "torus_angle": Variable(
        ("event",), "angle in revolutions of the multiplier on the unit circle at the point"
    ),
    "torus_growth": Variable(
        ("event",),
        "change of the logarithm of the amplitude in a period of the orbit at the point, divided "
        "by the square of the amplitude; negative if the torus is stable",
        quantity="mixed",
    ),
    "torus_value": Variable(
        ("event",),
        "varied parameter at which a run settled on a stable torus",
        quantity="followed",
    ),
    "torus_number": Variable(
        ("event",), "rotation number of that torus, in revolutions per period of the orbit"
    ),
    "torus_error": Variable(
        ("event",), "difference of that rotation number between parts of the run"
    ),
    "torus_limit": Variable(
        ("event",),
        "rotation number extrapolated to the Neimark-Sacker point, from two stable tori",
    ),
}
