"""Impact dampers for a harmonically forced hard Duffing oscillator.

After S. Chatterjee, A. K. Mallik and A. Ghosh, "On impact dampers for non-linear vibrating
systems", Journal of Sound and Vibration 187(3), 403-420, 1995. The names below are loaded
when they are first used.
"""

from importlib import import_module

_HOMES = {
    "Oscillator": "parameters",
    "Damper": "parameters",
    "Settling": "ensemble",
    "simulate": "motions",
    "steady_motion": "motions",
    "frequency_response": "response",
    "harmonic_balance_response": "design",
    "suppression_band": "design",
    "optimum_clearance": "design",
    "clearance_sweep": "optimum",
    "subharmonic_suppression": "subharmonic",
    "migrate": "migration",
    "periodic_orbit": "periodic",
    "orbit_branch": "periodic",
    "complete_branches": "periodic",
    "harmonic_convergence": "harmonics",
}

__all__ = list(_HOMES)


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError(f"module 'impact_damper' has no attribute {name!r}")
    return getattr(import_module(f"impact_damper.{_HOMES[name]}"), name)


def __dir__():
    return __all__
