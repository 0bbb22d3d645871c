"""Costs of a motion with a damper: impacts, forces, losses, noise, and the pressure of contacts.

The force of a wall per unit of primary mass is f = r1 q + D q', with the penetration q, the contact
stiffness r1 and the dashpot coefficient D. This force accelerates the primary mass by -f and the
loose mass by f/rm. A contact loses the work of its dashpot. Over a period of the motion,

    work of the external force = loss in the machine's dashpot + loss in contacts.

Over other times the difference is stored as energy of the motion. The variable `power_error` states
the relative error of this balance, with the stored energy included.

The measure of noise is n <J^2>, the number n of impacts per unit of time times the mean square of
their impulses J. By Campbell's theorem this is the two-sided spectral density of the force of
impacts at random times, for frequencies between n and the inverse of the duration of an impact.
With this density impacts excite the thin plates of a machine's casing, which radiate noise.
(S. O. Rice, Bell System Technical Journal 23, 1944, section 1.5.)

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass and rm
the mass ratio.
"""

import numpy as np

from impact_damper.data.datasets import dataset, flag, shown_variable
from impact_damper.design.panels import integrals, largest, logged, sampled
from impact_damper.kernel.equation import energy, forcing_amplitude, spring
from impact_damper.kernel.single import side_of
from impact_damper.model.arguments import read_forced, read_state
from impact_damper.model.bounds import check_count, shown
from impact_damper.model.hertz import HertzContact
from impact_damper.model.machine import check_fit
from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    DAMPING,
    DASHPOT,
    FREQUENCY,
)
from impact_damper.motions.strobe_map import strobe_time

# If the first state is in a contact, the next flight is sought within PATIENCE forcing cycles.
PATIENCE = 2
# Largest number of forcing cycles of a motion. Each cycle takes about 10 kB of memory.
MOST_PERIODS = 10**4


def motion_costs(machine, damper, frequency, state, periods, *, start=None, contact=None):
    """Return the costs of a motion of a machine with its damper.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
        It must have a contact stiffness.
    frequency : float
        Forcing frequency, Hz.
    state : sequence of 4 floats
        A state of the motion, m and m/s.
    periods : int
        Number of forcing cycles over which the costs are measured. For a periodic motion use its
        period, and for a chaotic motion enough cycles for accurate means.
    start : float, optional
        Time of the state, s. The default is a quarter of a forcing cycle, the phase of the states
        that `steady_motion` returns.
    contact : HertzContact, optional
        Radius and materials with which the pressure in the contact is computed.

    Returns
    -------
    xarray.Dataset
        In SI units, with the variables of `measured_costs` and of `pressure_costs`.

        For a machine on a moving base the two powers have a special meaning. Let y be the
        displacement of the base, and k and c the stiffness and damping of the machine. Then
        `force_power` is the power of the force k y + c y'. `dashpot_power` is the power of the
        force c x', with the machine's displacement x in space. Because both ends of the dashpot
        move, `force_power` is not the power of the base's drive, and `dashpot_power` is not the
        loss in the dashpot. Their difference is the power that impacts lose.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    check_fit(machine, damper)
    if contact is not None and not isinstance(contact, HertzContact):
        raise TypeError(f"contact = {shown(contact)}: must be a HertzContact")
    costs = _costs(machine, damper, frequency, state, periods, start=start)
    pressed = pressure_costs(machine, damper, contact, float(costs["impact_speed"]))
    return costs.assign({name: shown_variable(name, value) for name, value in pressed.items()})


def pressure_costs(machine, damper, contact, speed) -> dict:
    """Return force and pressure of an elastic impact by Hertz's theory, and whether walls yield.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
    contact : HertzContact or None
    speed : float
        Largest speed of impact, m/s; 0 without impacts.

    Returns
    -------
    dict
        `hertz_force` (N) and `contact_pressure` (Pa), NaN if `contact` is None; the flag
        `contact_yields`, which says whether the material yields at this pressure.
    """
    force = pressure = np.nan
    yields = "unknown"
    if contact is not None:
        mass = machine.mass * damper.mass / (machine.mass + damper.mass)
        force = contact.impact(speed, mass).force if speed > 0 else 0.0
        pressure = contact.pressure(force)
        yields = contact.yields(pressure)
    return {
        "hertz_force": force,
        "contact_pressure": pressure,
        "contact_yields": flag("contact_yields", yields),
    }


def _costs(machine, damper, frequency, state, periods, *, start=None):
    """Return the dataset of `measured_costs`; the arguments are those of `motion_costs`."""
    model = read_forced(machine, damper, frequency)
    p, y = model.pack(), read_state(model, state)
    check_count("periods", periods, most=MOST_PERIODS)
    begin = strobe_time(p) if start is None else model.scales.read("start", start, "time")
    made = model.describe() | {"periods": int(periods)}
    return dataset(measured_costs(p, y, begin, periods), {}, made, "Costs of a motion", model)


def measured_costs(p, y, begin, periods) -> dict:
    """Return the dimensionless costs of a motion.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters, with a damper.
    y : array, shape (4,)
        State Z1, Z1', Z2, Z2' at the time `begin`.
    begin : float
    periods : int
        Number of forcing cycles. If the state is in a contact, the cycles begin in the next flight.

    Returns
    -------
    dict
        Values of dataset variables (`data.variables.costs`), keyed by name. They are dimensionless;
        forces and powers are divided by the primary mass. Variables that begin with "contact_",
        except `contact_force`, and the velocities of approach and departure are arrays with one
        entry for each whole contact. All other values are scalars. Means over impacts are NaN
        without impacts. Rates, forces and powers are NaN if the motion escapes over the barrier of
        a softening spring.
    """
    begin, y = _in_flight(p, y, begin)
    time = periods * 2 * np.pi / p[FREQUENCY]
    panels = sampled(p, y, begin, begin + time)
    escaped = np.isnan(panels.states[-1, -1, 0])
    time = np.nan if escaped else time
    data = {"costs_time": time} | _impacts(p, panels, time) | _extremes_and_powers(p, panels, time)
    status = "escaped" if escaped else "impacts" if data["impact_rate"] > 0 else "no_impact"
    return data | {"costs_status": flag("costs_status", status)}


def _in_flight(p, y, begin):
    """Return a time at which the loose mass is in flight, and the state at this time.

    They are `begin` and y if y is in flight, otherwise the middle of the next flight and the state
    there. If the contact does not end within PATIENCE, `begin` and y are returned.
    """
    if side_of(p, y) == 0:
        return begin, y
    _, log = logged(p, y, begin, np.array([begin + PATIENCE * 2 * np.pi / p[FREQUENCY]]))
    if not np.isfinite(log[0, 2]):
        return begin, y
    following = log[1, 1] if len(log) > 1 else log[0, 2] + np.pi / p[FREQUENCY]
    middle = (log[0, 2] + following) / 2
    states, _ = logged(p, y, begin, np.array([middle]))
    return middle, states[-1]


def _penetration(p, panels):
    """Return penetration and its time derivative at the nodes of panels, both 0 in flight.

    Panels are short intervals of time with nodes at which the state is known (`panels`).
    """
    wall = panels.wall[:, None]
    depth = np.where(wall, wall * panels.states[..., 2] - p[CLEARANCE], 0.0)
    return depth, wall * panels.states[..., 3]


def _impacts(p, panels, time):
    """Return the variables of single contacts, and the means, rates and noise of all contacts.

    A contact that is cut by the beginning or end of the motion is left out.
    """
    depth, rate = _penetration(p, panels)
    force = p[CONTACT_STIFFNESS] * depth + p[DASHPOT] * rate
    impulse, loss = (
        np.bincount(panels.contact + 1, integrals(panels, values), len(panels.log) + 1)[1:]
        for values in (force, p[DASHPOT] * rate**2)
    )
    wall, start, end, approach, departure = panels.log.T
    whole = np.isfinite(end) & (start > panels.times[0, 0])
    speed, count = np.abs(approach[whole]), np.sum(whole)
    return {
        "contact_wall": wall[whole],
        "contact_begin": start[whole],
        "contact_end": end[whole],
        "approach_velocity": approach[whole],
        "departure_velocity": departure[whole],
        "contact_impulse": impulse[whole],
        "contact_loss": loss[whole],
        "impact_rate": count / time,
        "impact_speed": np.max(speed, initial=0.0),
        "mean_impact_speed": np.mean(speed) if count else np.nan,
        "mean_impact_loss": np.mean(loss[whole]) if count else np.nan,
        "impulse_noise": np.sum(impulse[whole] ** 2) / time,
    }


def _extremes_and_powers(p, panels, time):
    """Return the variables of largest force, penetration and acceleration, and of mean powers."""
    depth, rate = _penetration(p, panels)
    contact = p[CONTACT_STIFFNESS] * depth + p[DASHPOT] * rate
    x, v = panels.states[..., 0], panels.states[..., 1]
    # `py_func` is the Python function of a compiled function; it accepts arrays.
    external = forcing_amplitude.py_func(p) * np.cos(p[FREQUENCY] * panels.times)
    acceleration = external - p[DAMPING] * v - spring.py_func(p, x)
    powers = external * v, p[DAMPING] * v**2, p[DASHPOT] * rate**2
    work, damped, lost = (np.sum(integrals(panels, each)) / time for each in powers)
    first, last = (energy.py_func(p, panels.states[place, place]) for place in (0, -1))
    stored = (last - first) / time
    return {
        "contact_force": largest(contact),
        "penetration": largest(depth),
        "largest_acceleration": largest(acceleration - panels.wall[:, None] * contact),
        "force_power": work,
        "dashpot_power": damped,
        "impact_power": lost,
        "stored_power": stored,
        "power_error": (work - damped - lost - stored) / (damped + lost),
    }
