"""Impact dampers for a harmonically forced Duffing oscillator.

After S. Chatterjee, A. K. Mallik and A. Ghosh, "On impact dampers for non-linear vibrating
systems", Journal of Sound and Vibration 187(3), 403-420, 1995. Results are labelled datasets of
xarray. A quiet motion is the small motion with damper for which a damper is designed. The public
names are loaded when they are first used:

The system without units
    Oscillator, Damper
    Settling                    length and accuracy of runs

The system in SI units: all functions below take a machine in place of the oscillator
    Machine                     its method `damper` returns a damper for the machine
    HertzContact, Material, hertz_stiffness
    TunedAbsorber

Motions
    simulate                    one motion from a given state
    steady_motion               the motion to which a state leads
    frequency_response          all motions found at each frequency
    basins                      the motion to which each state of a plane leads
    migrate                     from the resonance to a small motion, by switching the damper

Periodic orbits, stable or not
    periodic_orbit, orbit_branch, complete_branches

Harmonic balance
    harmonic_balance_response, suppression_band, optimum_clearance

Design
    clearance_sweep             the clearance with the smallest quiet motion
    design_damper               a damper for a machine and a band of frequencies
    absorber_responses          tuned absorbers of the same mass, for comparison

Reading results
    decode                      names of the numbers of a flag, such as an outcome
    plot                        plot.response, plot.orbit and others
"""

from importlib import import_module

__version__ = "0.1.0"

# Module of each public name.
_HOMES = {
    "Oscillator": "model.parameters",
    "Damper": "model.parameters",
    "Settling": "model.settling",
    "Machine": "model.machine",
    "HertzContact": "model.hertz",
    "Material": "model.hertz",
    "hertz_stiffness": "design.contact_stiffness",
    "simulate": "motions.simulate",
    "steady_motion": "motions.steady",
    "frequency_response": "motions.response",
    "basins": "orbits.basins",
    "migrate": "motions.migration",
    "periodic_orbit": "orbits.orbit_branch",
    "orbit_branch": "orbits.orbit_branch",
    "complete_branches": "orbits.all_branches",
    "harmonic_balance_response": "theory.harmonic_balance",
    "suppression_band": "theory.suppression_band",
    "optimum_clearance": "theory.harmonic_balance",
    "clearance_sweep": "orbits.clearance_sweep",
    "design_damper": "design.design_damper",
    "decode": "data.datasets",
}


__all__ = list(_HOMES)


def __getattr__(name):
    if name == "plot":
        return import_module("impact_damper.plot")
    if name not in _HOMES:
        from impact_damper.model.names import nearest

        words = nearest(name, _HOMES)
        raise AttributeError(f"module 'impact_damper' has no attribute {name!r}{words}")
    found = getattr(import_module(f"impact_damper.{_HOMES[name]}"), name)
    if not isinstance(found, type):
        found = import_module("impact_damper.model.names").names_arguments(found)
    # Once loaded, a name is found without this function.
    globals()[name] = found
    return found


def __dir__():
    return [*__all__, "plot", "__version__"]
