"""Tuned absorbers, which could be built in place of an impact damper."""

from impact_damper.data.variables.variable import Variable

GRID = ("competitor", "detuning", "frequency", "force_share")
PEAK = ("competitor", "detuning", "force_share")
VARIABLES = {
    "competitor": Variable(("competitor",), "absorber in place of an impact damper, or none"),
    "detuning": Variable(
        ("detuning",), "fraction by which the absorber's springs are stiffer than designed"
    ),
    "force_share": Variable(("force_share",), "factor of the machine's excitation"),
    "competitor_displacement": Variable(
        GRID, "largest displacement in the largest motion found", quantity="displacement"
    ),
    "competitor_least_displacement": Variable(
        GRID, "largest displacement in the smallest motion found", quantity="displacement"
    ),
    "competitor_peak": Variable(
        PEAK,
        "largest displacement between the first and the last frequency",
        quantity="displacement",
    ),
    "competitor_peak_frequency": Variable(
        PEAK, "frequency of the largest displacement", quantity="frequency"
    ),
    "competitor_motions": Variable(GRID, "number of stable periodic motions found"),
    "competitor_share": Variable(GRID, "share of starts that lead to the largest motion"),
    "competitor_escaped": Variable(
        GRID, "share of starts that escape over the barrier of a softening spring"
    ),
    "competitor_status": Variable(
        GRID,
        "found: all starts that do not escape lead to stable periodic motions; not_periodic: some "
        "lead to a motion without a short period; not_settled: some motions did not settle",
        flags={
            "not_possible": -1,
            "escaped": 0,
            "found": 1,
            "not_periodic": 2,
            "not_settled": 3,
        },
    ),
    "absorber_stiffness": Variable(
        GRID[:2], "stiffness of the absorber's spring", quantity="stiffness"
    ),
    "absorber_damping": Variable(
        GRID[:2], "coefficient of the absorber's dashpot", quantity="damping"
    ),
    "absorber_cubic_stiffness": Variable(
        GRID[:2], "cubic stiffness of the absorber's spring", quantity="cubic_stiffness"
    ),
}
