"""Other programs that integrate motions with contacts, each as its own documentation recommends.

Each module has three functions. `obstacle` returns why the program is not available, or an empty
string. `version` returns a text. `prepare` returns a function of starts, which returns the states
at the end of a scene and the numbers of contacts.
"""

from importlib.util import find_spec
from typing import NamedTuple

from impact_damper.kernel.equation import forcing_amplitude
from impact_damper.model import packed


class Coefficients(NamedTuple):
    """Coefficients of the equations: `wall` is r1, and `heavy` 1 plus the inverse mass ratio."""

    damping: float
    stiffness: float
    cubic: float
    amplitude: float
    frequency: float
    clearance: float
    wall: float
    dashpot: float
    heavy: float


def coefficients(p):
    """Return the coefficients from packed parameters."""
    force = p[packed.DAMPING], *packed.cubic_spring(p), forcing_amplitude.py_func(p)
    walls = p[packed.CLEARANCE], p[packed.CONTACT_STIFFNESS], p[packed.DASHPOT]
    heavy = 1 + p[packed.INVERSE_MASS_RATIO]
    return Coefficients(*map(float, (*force, p[packed.FREQUENCY], *walls, heavy)))


def lacks(module, package):
    """Return a text if a package is missing (its module cannot be found), or an empty string."""
    return "" if find_spec(module) else f"no {package} (pip install 'impact-damper[benchmark]')"
