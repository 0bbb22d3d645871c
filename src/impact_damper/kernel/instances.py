"""Modules with the integration step, for a given number of lanes and given orders of the series.

A lane holds one of the trajectories that are stepped side by side.
"""

import importlib.util
import inspect
import os
import sys

from impact_damper.kernel.compiling import CACHE_DIRECTORY
from impact_damper.kernel.evaluation import Source
from impact_damper.kernel.series import SERIES, SINGLE
from impact_damper.kernel.templates import contact, forcing, root_search, separation, step

# Orders of the Taylor series. With these the integration is cheapest at medium errors.
FLIGHT_ORDER = 18
CONTACT_ORDER = 23


def instance(lanes, flight_order=FLIGHT_ORDER, contact_order=CONTACT_ORDER):
    """Return the module with the step for a number of lanes and the orders of the series.

    The source of the module is written to a file in the folder of the compiled kernels, whose name
    is the digest of all sources.
    """
    name = f"impact_damper_step_{lanes}_{flight_order}_{contact_order}"
    if name in sys.modules:
        return sys.modules[name]
    path = CACHE_DIRECTORY / f"{name}.py"
    if not path.exists():
        part = path.with_name(f"{path.name}.part-{os.getpid()}")
        part.write_text(_source(Source(lanes, flight_order, contact_order)))
        os.replace(part, path)
    specification = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    sys.modules[name] = module
    return module


def _source(writer):
    """Return the source of the module: constants, kernels of the series, and the templates."""
    constants = {
        "LANES": writer.lanes,
        "TANGENTS": writer.tangents,
        "FLIGHT_ORDER": writer.orders["flight"],
        "CONTACT_ORDER": writer.orders["contact"],
        # Order of the first of the coefficients from which `step.predict_length` extrapolates.
        "EARLY": 3 * (writer.orders["flight"] - 1) // 5 + 1,
        "SIZE": writer.rows["ROWS"] * writer.lanes,
        "TANGENT_SIZE": writer.rows["TANGENT_ROWS"] * writer.tangents,
    }
    constants |= {name: writer.rows[name] * writer.lanes for name in [*SINGLE, *SERIES]}
    lines = "".join(f"{name} = {value}\n" for name, value in constants.items())
    templates = forcing, root_search, contact, separation, step
    return "\n\n".join([lines, writer.text(), *map(inspect.getsource, templates)])
