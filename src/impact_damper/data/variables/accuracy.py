"""Error against counted work: methods and models on scenes."""

from impact_damper.data.variables.variable import Variable

RUN = ("run",)

VARIABLES = {
    "method": Variable(RUN, "method of integration or model"),
    "setting": Variable(RUN, "its tolerance, or for a balance its highest harmonic"),
    "run_status": Variable(
        RUN,
        "how it ended, and its contacts against the reference's: fewer are missed, more invented",
        flags={
            "ok": 0,
            "missed_contacts": 1,
            "invented_contacts": 2,
            "failed": 3,
            "capped": 4,
            "not_applicable": 5,
        },
    ),
    "operations": Variable(
        RUN,
        "counted work: floating-point operations, elementary functions as 20; of integrators for "
        "the run, of models for the orbit, by the formulas in modules runs and orbit_models",
    ),
    "state_error": Variable(RUN, "largest error of a component of the state at the end"),
    "contact_time_error": Variable(
        RUN, "largest error of the beginning of a contact, NaN where their number is wrong", "T"
    ),
    "contact_excess": Variable(RUN, "contacts less those of the reference"),
    "amplitude_error": Variable(RUN, "relative error of max |Z1|"),
    "statistic": Variable(("statistic",), "average of a chaotic motion"),
    "average": Variable(
        (*RUN, "statistic"),
        "contacts a period, mean of max |Z1| of a period, largest Lyapunov exponent",
    ),
    "average_error": Variable((*RUN, "statistic"), "standard error of it, by batches"),
    "reference_average": Variable(("statistic",), "that of the reference"),
    "reference_average_error": Variable(("statistic",), "standard error of it"),
    "meets_accuracy": Variable(
        RUN, "whether the accuracy that the scene states is met", flags={"no": 0, "yes": 1}
    ),
    "reference_state": Variable(("component",), "state of the reference at the end"),
    "reference_contacts": Variable((), "contacts of the reference"),
    "reference_amplitude": Variable((), "max |Z1| of the reference", "max |Z1|"),
}
