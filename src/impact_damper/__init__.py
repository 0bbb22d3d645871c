"""Impact dampers for a harmonically forced Duffing oscillator.

After S. Chatterjee, A. K. Mallik and A. Ghosh, "On impact dampers for non-linear vibrating
systems", Journal of Sound and Vibration 187(3), 403-420, 1995. Results are labelled datasets of
xarray. The public names are loaded when they are first used:

The system
    Oscillator, Damper          dimensionless
    Machine                     in SI units; its method `damper` returns a damper for the machine
    HertzContact                contact of curved bodies, and its stiffness
    Settling                    length and accuracy of runs

Motions
    simulate                    one motion from a given state
    steady_motion               the motion to which a state leads
    frequency_response          all motions found at each frequency
    basins                      the motion to which each state of a plane leads
    migrate                     from the resonance to a small motion, by switching the damper

Periodic orbits, stable or not
    periodic_orbit, orbit_branches

Harmonic balance
    harmonic_balance            the frequency response, and the band that the damper suppresses

Design
    clearance_sweep             the clearance with the smallest quiet motion
    design_damper               a damper for a machine and a band of frequencies
    evaluate_damper             what a machine does with a damper that exists
    Effort                      how much a design computes

Reading results
    decode                      names of the numbers of a flag, such as an outcome
    plot                        plot.response, plot.orbit and others
"""

import lazy_loader

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
