"""Largest displacement over the clearance, and its minimum (figures 6, 7 and 11 of the paper)."""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.data.sweeps import runs_of_true
from impact_damper.model import bounds
from impact_damper.model.arguments import read_increasing, read_radius, read_swept_damper
from impact_damper.model.packed import CLEARANCE, pack
from impact_damper.model.parameters import check_closed_form, describe
from impact_damper.model.settling import check_settling
from impact_damper.motions.records import is_symmetric_pair
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.motions.start_states import describe_search, search_starts
from impact_damper.motions.sweep import reached, sweep
from impact_damper.orbits.branches import between, follow_branch
from impact_damper.orbits.shooting import find_orbit
from impact_damper.theory.design_rule import rule_clearance
from impact_damper.theory.harmonic_balance import analytical_table
from impact_damper.theory.straight_flight import Flight, least_displacement_ratio

METHODS = "simulated", "harmonic_balance"


@bounds.names_arguments
def clearance_sweep(
    system,
    damper,
    frequency,
    clearances,
    *,
    method="simulated",
    starts=24,
    radius=None,
    whole_gap=False,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Find all motions at each clearance of a sweep, and the optimum clearance of the quiet orbit.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : dict, Damper or MachineDamper
        The clearance of the damper is ignored. With an `Oscillator`, the damper may be a dictionary
        of arguments of `Damper` without the clearance.
    frequency : float
        Forcing frequency W, or Hz for a machine.
    clearances : sequence of float
        Increasing clearances d0. For a machine: increasing gaps (full play) in m, as `gap` in
        `Machine.damper`. The coordinate `clearance` of the result then holds gaps in mm.
    method : str
        "simulated" finds the motions. "harmonic_balance" only solves equations: the result holds
        the amplitude and the optimum by equation (7), and the clearances by rules (18) and (19).
    starts, radius, whole_gap, seed, settling, workers, progress
        As in `frequency_response`, for each clearance.

    Returns
    -------
    xarray.Dataset
        For each (clearance, motion): the variables of `frequency_response`. For each `clearance`:
        max |Z1| of the quiet orbit (period 1, symmetric, two contacts; absent with gravity,
        because no motion is symmetric then), the largest |Z1| of all motions to which starts lead,
        and the amplitude of the smallest stable solution of (7). Scalars: the clearance of the
        smallest quiet orbit (the optimum); the kind of this minimum, which is smooth, a kink, an
        end of the branch, or an end of the sweep; the optimum by (7); the clearances by rules (18)
        and (19), NaN for (19) without a resonance peak; rm W^2 d0/f at the optimum, with the mass
        ratio rm and the amplitude f = F + U W^2 of the force; the value of rm W^2 d0/f at which max
        |Z1| is smallest by the theory of straight flight. For each `edge`, lower and upper: the end
        of the range of clearances in which max |Z1| of the quiet orbit exceeds its minimum by at
        most 10 %.

    Raises
    ------
    TypeError
        If `damper` is neither a damper nor a dictionary of its arguments.
    ValueError
        If clearances are not increasing, or a parameter is out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> import numpy as np
    >>> oscillator, clearances = idm.Oscillator(0.215), np.linspace(2.0, 2.8, 9)
    >>> best = idm.clearance_sweep(oscillator, {"mass_ratio": 0.12}, 2.0, clearances)
    >>> round(float(best.optimum_clearance), 4)
    2.3944
    """
    if method not in METHODS:
        raise ValueError(f"method = {bounds.shown(method)}: must be one of {', '.join(METHODS)}")
    settling = check_settling(settling)
    bounds.check_count("seed", seed, **bounds.SEED_RANGE)
    model = read_swept_damper(system, damper, frequency)
    oscillator, frequency = model.oscillator, model.frequency
    limits = bounds.CLEARANCE_RANGE
    clearances = read_increasing(model.scales, "clearances", clearances, "gap", 2, **limits)
    bounds.check_starts(starts, len(clearances))
    radius = read_radius(model.scales, radius, whole_gap)
    if method == "harmonic_balance":
        check_closed_form(oscillator, model.damper)
    dampers = [replace(model.damper, clearance=float(value)) for value in clearances]
    mass_ratio, forcing = model.damper.mass_ratio, oscillator.forcing_amplitude(frequency)
    inertia = mass_ratio * frequency**2
    balance = analytical_table(oscillator, dampers, frequency) | {
        "rule_clearance": forcing / inertia,
        "peak_rule_clearance": _peak_rule(oscillator, mass_ratio),
    }
    title = "Largest displacement against clearance"
    swept = describe(model.damper) | {"frequency": frequency}
    del swept["clearance"]
    if method == "harmonic_balance":
        made = describe(oscillator) | swept
        return dataset(balance, {"clearance": clearances}, made, title, model)
    parameters = np.array([pack(oscillator, each, frequency) for each in dampers])
    systems = [(each, frequency) for each in dampers]
    drawn = starts, radius, seed
    search = search_starts(oscillator, systems, *drawn, settling, whole_gap=whole_gap)
    running = {"workers": workers, "progress": progress}
    data = sweep(parameters, CLEARANCE, "clearance", search, settling, **running)
    states, sizes, anchor = _quiet_motions(data, clearances, forcing / inertia)
    known = "found", "absent"
    data |= balance | {
        "quiet_displacement": sizes,
        "quiet_status": [flag("quiet_status", known[int(np.isnan(size))]) for size in sizes],
    }
    span = float(clearances[0]), float(clearances[-1])
    part = np.empty(0), np.empty(0), None
    if anchor is not None:
        part = _stable_part(parameters[anchor], states[anchor], span)
    data |= minimum_table(*part, span)
    sizes = np.where(reached(data), data["maximum_displacement"][1], -np.inf)
    flight = Flight(mass_ratio, model.damper.restitution)
    data |= {
        "largest_displacement": np.max(sizes, axis=1),
        "optimum_ratio": inertia * data["optimum_clearance"] / forcing,
        "straight_flight_ratio": least_displacement_ratio(flight),
    }
    made = describe(oscillator, settling) | swept | describe_search(*drawn, whole_gap)
    edges = ["lower", "upper"]
    coordinates = {"clearance": clearances, "component": list(COMPONENTS), "edge": edges}
    return dataset(data, coordinates, made, title, model)


def _peak_rule(oscillator, mass_ratio):
    try:
        return rule_clearance(oscillator, mass_ratio)
    except ValueError:
        return np.nan


def _quiet_motions(data, clearances, rule):
    names = "outcome period contacts asymmetry maximum_displacement branch state"
    table = {name: data[name][1] for name in names.split()}
    quiet = is_settled(table) & is_symmetric_pair(table)
    size = np.where(quiet, table["maximum_displacement"], np.nan)
    rows, anchor = np.flatnonzero(quiet.any(axis=1)), None
    if len(rows):
        anchor = rows[np.argmin(np.abs(np.log(clearances[rows] / rule)))]
        # Keep only the branch of the smallest quiet orbit at clearances[anchor].
        quiet &= table["branch"] == table["branch"][anchor, np.nanargmin(size[anchor])]
    column, row = np.argmax(quiet, axis=1), np.arange(len(clearances))
    sizes = np.where(quiet.any(axis=1), size[row, column], np.nan)
    return table["state"][row, column], sizes, anchor


def _stable_part(p, state, span):
    """Follow a branch over the clearances in `span` as long as its orbits are stable.

    The branch contains the orbit near `state` with the parameters `p`. Return clearances, max |Z1|
    at these clearances, and a function that computes max |Z1| for a clearance between them.
    """

    def family(clearance):
        changed = p.copy()
        changed[CLEARANCE] = clearance
        return changed

    branch = follow_branch(family, find_orbit(p, state), p[CLEARANCE], span, beyond=0)
    stable = np.array([point.orbit.stable for point in branch.points])
    anchor = np.argmin(np.abs(branch.values - p[CLEARANCE]))
    stable[anchor] = True
    first, last = next(ends for ends in runs_of_true(stable) if ends[0] <= anchor < ends[1])
    values, points = branch.values[first:last], branch.points[first:last]

    def size_at(clearance):
        k = np.clip(np.searchsorted(values, clearance) - 1, 0, max(len(values) - 2, 0))
        point = between(points[k], points[min(k + 1, len(values) - 1)], clearance)
        return np.inf if point is None else float(point.orbit.record["maximum_displacement"])

    return values, branch.displacements[first:last], size_at


# The range of clearances near the optimum ends where max |Z1| is NEAR_MINIMUM times its minimum.
NEAR_MINIMUM = 1.1
# A smooth minimum is refined: it is placed where a central difference of max |Z1| is zero.
# The step of the difference is DIFFERENCE x clearance, the largest correction WIDE x clearance.
DIFFERENCE, WIDE = 3e-5, 1e-4


def minimum_table(values, sizes, size_at, span):
    """Return the dataset variables that describe the smallest max |Z1| of stable quiet orbits.

    `values` and `sizes` are clearances and max |Z1|. `size_at` computes max |Z1| for a clearance.
    `span` is the least and the greatest clearance of the sweep.
    """
    if not len(values):
        return {
            "optimum_clearance": np.nan,
            "optimum_displacement": np.nan,
            "optimum_kind": flag("optimum_kind", "not_found"),
            "near_clearance": np.full(2, np.nan),
        }
    k = int(np.argmin(sizes))
    ends = values[max(k - 1, 0)], values[min(k + 1, len(values) - 1)]
    inner = minimize_scalar(size_at, bounds=ends, method="bounded", options={"xatol": 1e-9})
    best, least = min((values[k], sizes[k]), (inner.x, inner.fun), key=lambda pair: pair[1])
    room = min(best - values[0], values[-1] - best)
    if room < 1e-6:
        end = values[0 if best - values[0] == room else -1]
        kind = "edge" if end in span else "jump"
    else:
        kind = _kind(size_at, best, least, min(1e-3 * best, room))
    if kind == "smooth" and room > 2 * WIDE * best:
        best = _stationary(size_at, best)
        least = size_at(best)
    near = [_near(values[::step], sizes[::step], size_at, best, least) for step in (-1, 1)]
    return {
        "optimum_clearance": best,
        "optimum_displacement": least,
        "optimum_kind": flag("optimum_kind", kind),
        "near_clearance": np.array(near),
    }


def _stationary(size_at, best):
    step, reach = DIFFERENCE * best, WIDE * best

    def slope(clearance):
        return size_at(clearance + step) - size_at(clearance - step)

    if not slope(best - reach) < 0 < slope(best + reach):
        return best
    return brentq(slope, best - reach, best + reach, xtol=1e-11 * best)


def _kind(size_at, best, least, longest):
    # Halving the distance from `best` divides the rise of max |Z1| by 4 (smooth) or by 2 (kink).
    steps = longest, longest / 2
    rises = [size_at(best + step) + size_at(best - step) - 2 * least for step in steps]
    return "kink" if rises[1] > 0.36 * rises[0] else "smooth"


def _near(values, sizes, size_at, best, least):
    level = NEAR_MINIMUM * least
    inside = best
    for value, size in zip(values, sizes, strict=True):
        if (value - best) * (values[-1] - best) <= 0:
            continue
        if size > level:
            return brentq(lambda x: size_at(x) - level, inside, value)
        inside = value
    return values[-1]
