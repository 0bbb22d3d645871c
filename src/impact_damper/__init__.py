"""Impact dampers for a harmonically forced hard Duffing oscillator.

After S. Chatterjee, A. K. Mallik and A. Ghosh, "On impact dampers for non-linear vibrating
systems", Journal of Sound and Vibration 187(3), 403-420, 1995. The names below are loaded
when they are first used.
"""

from importlib import import_module

_HOMES = {
    "Oscillator": "system.parameters",
    "Damper": "system.parameters",
    "Settling": "system.settling",
    "Machine": "machine.machine",
    "HertzContact": "machine.hertz",
    "Material": "machine.hertz",
    "TunedAbsorber": "absorbers.absorber",
    "absorber_responses": "absorbers.responses",
    "hertz_stiffness": "performance.contact_stiffness",
    "design_damper": "stages.machines",
    "simulate": "motions.simulate",
    "steady_motion": "motions.steady",
    "frequency_response": "stages.response",
    "harmonic_balance_response": "stages.harmonic_balance",
    "suppression_band": "stages.suppression_band",
    "optimum_clearance": "stages.harmonic_balance",
    "clearance_sweep": "stages.optimum",
    "subharmonic_suppression": "stages.subharmonic",
    "migrate": "stages.migration",
    "periodic_orbit": "stages.branches",
    "orbit_branch": "stages.branches",
    "complete_branches": "stages.branches",
    "harmonic_convergence": "stages.harmonic_convergence",
}

# Functions that take a machine in place of the oscillator too, with all else in SI units.
_OF_MACHINES = {
    "simulate",
    "steady_motion",
    "frequency_response",
    "harmonic_balance_response",
    "suppression_band",
    "optimum_clearance",
    "clearance_sweep",
    "subharmonic_suppression",
    "migrate",
    "periodic_orbit",
    "orbit_branch",
    "complete_branches",
    "harmonic_convergence",
}

__all__ = list(_HOMES)


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError(f"module 'impact_damper' has no attribute {name!r}")
    found = getattr(import_module(f"impact_damper.{_HOMES[name]}"), name)
    if name in _OF_MACHINES:
        found = import_module("impact_damper.machine.arguments").takes_machine(found)
    # Once loaded, a name is found without this function.
    globals()[name] = found
    return found


def __dir__():
    return __all__
