"""The page of a machine: what to build, its effect, how sure the result is, and alternatives."""

from impact_damper.plot.machine_figures import (
    cliff,
    competitors,
    drawing,
    masses,
    operating,
    response,
    tolerances,
    transients,
)
from impact_damper.plot.pages import advice, build, costs, effect, limits, others, sureness
from impact_damper.plot.pages.blocks import Page

# Functions that draw the figures of a page, keyed by the name of the file without its ending.
FIGURES = {
    "drawing": drawing.draw_drawing,
    "response": response.draw_response,
    "transients": transients.draw_transients,
    "cliff": cliff.draw_cliff,
    "tolerances": tolerances.draw_tolerances,
    "forces": operating.draw_forces,
    "dampers": operating.draw_dampers,
    "competitors": competitors.draw_competitors,
    "masses": masses.draw_masses,
}


def machine_page(name, data, file=None) -> Page:
    """Return the page of a machine.

    Parameters
    ----------
    name : str
        Name of the entry in the configuration.
    data : xarray.Dataset
        Of `stages.machines.design_damper`.
    file : str, optional
        Name of the file of `data`, by default that of the pipeline.
    """
    return Page(
        f"Impact damper for the machine {name.replace('_', ' ')}",
        advice.advice(data),
        advice.reasons(data),
        [
            build.section(data),
            effect.section(data),
            sureness.section(data),
            costs.section(data),
            others.section(data),
            limits.missing(data),
            limits.origin(file or f"{name}.nc", data),
        ],
    )
