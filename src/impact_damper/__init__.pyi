from . import plot as plot
from .data.datasets import decode as decode
from .design.design_damper import design_damper as design_damper
from .design.design_damper import evaluate_damper as evaluate_damper
from .design.task import Effort as Effort
from .model.hertz import HertzContact as HertzContact
from .model.machine import Machine as Machine
from .model.parameters import Damper as Damper
from .model.parameters import Oscillator as Oscillator
from .model.settling import Settling as Settling
from .motions.migration import migrate as migrate
from .motions.response import frequency_response as frequency_response
from .motions.simulate import simulate as simulate
from .motions.steady import steady_motion as steady_motion
from .orbits.basins import basins as basins
from .orbits.clearance_sweep import clearance_sweep as clearance_sweep
from .orbits.orbit_branches import orbit_branches as orbit_branches
from .orbits.orbit_branches import periodic_orbit as periodic_orbit
from .theory.harmonic_balance import harmonic_balance as harmonic_balance

__version__: str
