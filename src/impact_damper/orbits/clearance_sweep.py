"""Largest displacement as a function of the clearance, and its minimum (figures 6, 7 and 11).

The motion is the quiet motion: of period 1, symmetric, with two contacts per cycle. Of several
branches the one nearest to the clearance of rule (18), rm W^2 d0 = f, is taken.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from impact_damper.data.datasets import dataset, flag
from impact_damper.model.arguments import read_increasing, read_radius, read_swept_damper
from impact_damper.model.bounds import (
    CLEARANCE_RANGE,
    SEED_RANGE,
    check_count,
    check_starts,
    names_arguments,
    shown,
)
from impact_damper.model.packed import CLEARANCE, pack
from impact_damper.model.parameters import describe
from impact_damper.model.settling import check_settling
from impact_damper.motions.following import RESOLUTION, follow_stable
from impact_damper.motions.records import measured
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.motions.start_states import describe_search, search_starts
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.motions.sweep import SAME, reached, sweep
from impact_damper.theory.design_rule import rule_clearance
from impact_damper.theory.optimum_clearance import analytical_table, straight_flight_ratio

# Parameters of the damper that are the same at all clearances.
SWEPT_WITH = {"mass_ratio", "restitution", "contact_stiffness"}
METHODS = "simulated", "harmonic_balance"


@names_arguments
def clearance_sweep(
    system,
    damper,
    frequency,
    clearances,
    *,
    method="simulated",
    starts=24,
    radius=None,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Find all motions at each clearance of a sweep, and the optimum clearance.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : dict, Damper or MachineDamper
        Its clearance is ignored. A dictionary holds the arguments of `Damper` without the
        clearance.
    frequency : float
        Forcing frequency W, or Hz for a machine.
    clearances : sequence of float
        Increasing clearances d0; for a machine on each side, m.
    method : str
        "simulated", or "harmonic_balance" for the amplitude by (7) and the rules alone, without
        motions.
    starts, radius, seed, settling, workers, progress
        As in `frequency_response`, for each clearance.

    Returns
    -------
    xarray.Dataset
        For each (clearance, motion) a motion found, as in a frequency response. For each
        `clearance` max |Z1| of the quiet motion, of all motions to which starts lead, and the
        amplitude of the smallest stable solution of (7). Scalars: the optimum and the kind of
        minimum, for the quiet motion and for (7); the clearances of rules (18) and (19), NaN for
        (19) if the response without damper has no peak; rm W^2 d0/f at the optimum; and the shares
        of the excess of this ratio over 1 that pi^2/8 and the theory of straight flight explain.
        For each `edge` an end of the clearances with max |Z1| within 10 % of its minimum. The
        attribute `optimum` is a sentence on the optimum.

    Raises
    ------
    TypeError
        If `damper` is not such a dictionary.
    ValueError
        If clearances are not increasing, or a parameter is out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> import numpy as np
    >>> oscillator, gaps = idm.Oscillator(0.215), np.linspace(2.0, 2.8, 9)
    >>> best = idm.clearance_sweep(oscillator, {"mass_ratio": 0.12}, 2.0, gaps)
    >>> round(float(best.optimum_clearance), 4)
    2.3944
    """
    if method not in METHODS:
        raise ValueError(f"method = {shown(method)}: must be one of {', '.join(METHODS)}")
    settling = check_settling(settling)
    check_count("seed", seed, **SEED_RANGE)
    model = read_swept_damper(system, damper, frequency)
    oscillator, frequency = model.oscillator, model.frequency
    clearances = read_increasing(
        model.scales, "clearances", clearances, "clearance", 2, **CLEARANCE_RANGE
    )
    check_starts(starts, len(clearances))
    radius = read_radius(model.scales, radius)
    dampers = [replace(model.damper, clearance=float(value)) for value in clearances]
    balance = analytical_table(oscillator, dampers, frequency) | {
        "rule_clearance": oscillator.forcing_amplitude(frequency)
        / (model.damper.mass_ratio * frequency**2),
        "peak_rule_clearance": _peak_rule(oscillator, model.damper.mass_ratio),
    }
    title = "Largest displacement against clearance"
    swept = {name: getattr(model.damper, name) for name in sorted(SWEPT_WITH)}
    swept |= {"frequency": frequency}
    if method == "harmonic_balance":
        return dataset(
            balance, {"clearance": clearances}, describe(oscillator) | swept, title, model
        )
    parameters = np.array([pack(oscillator, each, frequency) for each in dampers])
    systems = [(each, frequency) for each in dampers]
    search = search_starts(oscillator, systems, starts, radius, seed, settling)
    running = {"workers": workers, "progress": progress}
    data = sweep(parameters, CLEARANCE, "clearance", search, settling, **running)
    forcing = oscillator.forcing_amplitude(frequency)
    inertia = dampers[0].mass_ratio * frequency**2
    branch = _quiet_branch(data, parameters, forcing / inertia)
    data |= _quiet_table(branch) | minimum_table(branch) | balance
    data |= {"largest_displacement": _largest(data)}
    data |= {
        "optimum_ratio": inertia * data["optimum_clearance"] / forcing,
        "straight_flight_ratio": straight_flight_ratio(
            dampers[0].mass_ratio, dampers[0].restitution
        ),
    }
    made = describe(oscillator, settling) | swept | describe_search(starts, radius, seed)
    coordinates = {
        "clearance": clearances,
        "component": list(COMPONENTS),
        "edge": ["lower", "upper"],
    }
    found = dataset(data, coordinates, made, title, model)
    return found.assign_attrs(optimum=_in_words(found))


def _peak_rule(oscillator, mass_ratio):
    """Return the clearance of rule (19); NaN if the response without damper has no peak."""
    try:
        return rule_clearance(oscillator, mass_ratio)
    except ValueError:
        return np.nan


def _quiet_branch(data, parameters, rule):
    """Return the `Branch` of quiet motions nearest to the clearance `rule`.

    If there is no quiet motion, all states and displacements of the branch are NaN.
    """
    names = "outcome period contacts asymmetry maximum_displacement branch state"
    table = {name: data[name][1] for name in names.split()}
    quiet = (
        (table["outcome"] == flag("outcome", "settled"))
        & (table["period"] == 1)
        & (np.abs(table["contacts"] - 2) < SAME)
        & (table["asymmetry"] < SAME)
    )
    size = np.where(quiet, table["maximum_displacement"], np.nan)
    rows = np.flatnonzero(quiet.any(axis=1))
    chosen = np.zeros_like(quiet)
    if len(rows):
        anchor = rows[np.argmin(np.abs(np.log(parameters[rows, CLEARANCE] / rule)))]
        number = table["branch"][anchor, np.nanargmin(size[anchor])]
        chosen = quiet & (table["branch"] == number)
    column = np.argmax(chosen, axis=1)
    row = np.arange(len(parameters))
    found = chosen.any(axis=1)
    return Branch(
        parameters,
        np.where(found[:, None], table["state"][row, column], np.nan),
        np.where(found, size[row, column], np.nan),
    )


def _quiet_table(branch):
    found = np.isfinite(branch.displacements)
    return {
        "quiet_displacement": branch.displacements,
        "quiet_status": np.where(
            found, flag("quiet_status", "found"), flag("quiet_status", "absent")
        ),
    }


def _largest(data):
    """Return the largest max |Z1| of the motions to which starts lead, for each clearance."""
    sizes = np.where(reached(data), data["maximum_displacement"][1], -np.inf)
    return np.max(sizes, axis=1)


def _in_words(sweep) -> str:
    """Return a sentence on the optimum of a sweep of the clearance, or that it has none.

    In SI units it gives the gap, the full play; otherwise the clearance, half of the gap.
    """
    unit = sweep["clearance"].attrs["units"]
    name, factor, suffix, play = "clearance", 1, "", ""
    if unit != "1":
        name, factor, suffix, play = "gap", 2, f" {unit}", " (full play)"
    least, most = factor * sweep["clearance"].values[[0, -1]]
    swept = f"{name}s from {least:g} to {most:g}{suffix}"
    kind = int(sweep["optimum_kind"])
    if kind == flag("optimum_kind", "not_found"):
        number = sweep.sizes["clearance"]
        return (
            f"no quiet motion: none of the starts, {sweep.sizes['start']} of them random, at each "
            f"of {number} {swept}{play} leads to one"
        )
    best, size = factor * float(sweep["optimum_clearance"]), float(sweep["optimum_displacement"])
    where = {"jump": ", where it ends", "edge": f", the end of the {swept}"}
    meanings = {flag("optimum_kind", each): text for each, text in where.items()}
    return (
        f"quiet motion of {size:.4g}{suffix} at the {name} {best:.4g}{suffix}{play}"
        f"{meanings.get(kind, '')}"
    )


# The range of clearances near the minimum ends where max |Z1| is NEAR_MINIMUM times its minimum.
NEAR_MINIMUM = 1.1


class Branch(NamedTuple):
    """A branch of motions of period 1 along a sweep of the clearance.

    parameters: Packed parameters, shape (n, packed.COUNT).
    states: State of the motion at W T = pi/2, NaN where the motion is absent; shape (n, 4).
    displacements: max |Z1|, NaN where the motion is absent; shape (n,).
    """

    parameters: np.ndarray
    states: np.ndarray
    displacements: np.ndarray

    def follow(self, start, clearance):
        """Follow the motion from the known point nearest to `start` to a clearance.

        Return the packed parameters and the `StrobeOrbit` at the last clearance reached.
        """
        away = np.abs(self.parameters[:, CLEARANCE] - start)
        k = np.nanargmin(np.where(np.isfinite(self.displacements), away, np.nan))
        return follow_stable(self.parameters[k], self.states[k], 1, CLEARANCE, clearance)

    def displacement(self, clearance):
        """Return max |Z1| at a clearance; infinity beyond the end of the branch."""
        p, orbit = self.follow(clearance, clearance)
        if p[CLEARANCE] != clearance:
            return np.inf
        return measured(p, orbit.state, 1, POLISH_TOLERANCE)["maximum_displacement"]

    def limit(self, clearance, step):
        """Return the next clearance of the sweep in the direction `step` (-1 or 1), and "crossed".

        If the branch ends before that clearance, return the end of the branch and "branch_ends". If
        the sweep has no further clearance, return the given clearance and "sweep_ends".
        """
        grid = self.parameters[:, CLEARANCE]
        beyond = grid[grid > clearance][:1] if step > 0 else grid[grid < clearance][-1:]
        if len(beyond) == 0:
            return clearance, "sweep_ends"
        reached = self.follow(clearance, beyond[0])[0][CLEARANCE]
        if reached == beyond[0]:
            return reached, "crossed"
        return reached - 10 * step * RESOLUTION, "branch_ends"


def minimum_table(branch):
    """Return the variables of the minimum of max |Z1| along a `Branch`, a dict.

    They are the clearance and max |Z1| at the minimum, its kind, and the range of clearances near
    it. Kinds: "smooth", "kink", "jump" (at the end of the branch), "edge" (at the end of the sweep)
    and "not_found".
    """
    if not np.isfinite(branch.displacements).any():
        return {
            "optimum_clearance": np.nan,
            "optimum_displacement": np.nan,
            "optimum_kind": flag("optimum_kind", "not_found"),
            "near_clearance": np.full(2, np.nan),
            "near_status": np.full(2, flag("near_status", "not_found")),
        }
    middle = branch.parameters[np.nanargmin(branch.displacements), CLEARANCE]
    limits = [branch.limit(middle, step) for step in (-1, 1)]
    bounds = [value for value, _ in limits]
    inner = minimize_scalar(
        branch.displacement, bounds=bounds, method="bounded", options={"xatol": 1e-9}
    )
    candidates = {value: branch.displacement(value) for value in bounds} | {inner.x: inner.fun}
    best = min(candidates, key=candidates.get)
    room = [abs(best - value) for value, event in limits if event == "branch_ends"]
    kind = _kind(branch, best, candidates[best], min([1e-3 * best, *room]))
    for value, event in limits:
        if abs(best - value) < 1e-6 and event != "crossed":
            kind = "jump" if event == "branch_ends" else "edge"
    near = [_near(branch, best, NEAR_MINIMUM * candidates[best], step) for step in (-1, 1)]
    return {
        "optimum_clearance": best,
        "optimum_displacement": candidates[best],
        "optimum_kind": flag("optimum_kind", kind),
        "near_clearance": np.array([value for value, _ in near]),
        "near_status": np.array([flag("near_status", event) for _, event in near]),
    }


def _kind(branch, best, least, longest):
    """Return "smooth" or "kink" for a minimum.

    The kind follows from the rise of max |Z1| after a step away from the minimum. When the step is
    halved, the rise falls to a quarter at a smooth minimum and to half at a kink. `longest` is the
    longest step that stays on the branch.
    """
    rises = [
        branch.displacement(best + step) + branch.displacement(best - step) - 2 * least
        for step in (longest, longest / 2)
    ]
    # 0.36 lies between a quarter and a half: it is close to their geometric mean.
    return "kink" if rises[1] > 0.36 * rises[0] else "smooth"


def _near(branch, best, level, step):
    """Return the clearance where max |Z1| reaches a level on one side of the optimum.

    `best` is the optimum, and `step` is -1 or 1, the side. The second result is "crossed". If the
    branch or the sweep ends before the level is reached, its end and "branch_ends" or "sweep_ends"
    are returned.
    """
    outside, event = best, "crossed"
    while event == "crossed":
        inside = outside
        outside, event = branch.limit(inside, step)
        if branch.displacement(outside) > level:
            return brentq(lambda x: branch.displacement(x) - level, inside, outside), "crossed"
    return outside, event
