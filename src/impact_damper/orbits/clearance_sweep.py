"""Largest displacement as a function of the clearance, and its minimum (figures 6, 7 and 11).

The motion is the quiet motion, for which a damper is designed: it has period 1, is symmetric and
has two contacts per cycle. A branch consists of the quiet motions at successive clearances that
belong together. If there are several branches, the one nearest to the clearance of rule (18) of the
paper, rm W^2 d0 = f, is taken. Here rm is the mass ratio, W the forcing frequency, d0 the clearance
and f the forcing amplitude.

Z1 is the displacement of the primary mass. A start is an initial state.
"""

from dataclasses import replace

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.model.arguments import read_increasing, read_radius, read_swept_damper
from impact_damper.model.bounds import CLEARANCE_RANGE, SEED_RANGE, check_count
from impact_damper.model.checks import (
    check_starts,
)
from impact_damper.model.names import names_arguments
from impact_damper.model.packed import CLEARANCE, pack
from impact_damper.model.parameters import describe
from impact_damper.model.settling import check_settling
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.motions.start_states import describe_search, search_starts
from impact_damper.motions.sweep import SAME, reached, sweep
from impact_damper.orbits.branch_minimum import Branch, minimum_table
from impact_damper.theory.harmonic_balance import optimum_clearance
from impact_damper.theory.optimum_clearance import analytical_table, excess_table

# Parameters of the damper that are the same at all clearances.
SWEPT_WITH = {"mass_ratio", "restitution", "contact_stiffness"}


@names_arguments
def clearance_sweep(
    system,
    damper,
    frequency,
    clearances,
    *,
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
    starts, radius, seed, settling, workers, progress
        As in `frequency_response`, for each clearance.

    Returns
    -------
    xarray.Dataset
        For each (clearance, motion) a motion found, as in a frequency response. For each
        `clearance` max |Z1| of the quiet motion, the largest max |Z1| of all motions to which
        starts lead, and the amplitude |a| of the smallest stable solution of the harmonic balance
        (7). Scalars: the optimum and the kind of minimum, both for the quiet motion and for (7);
        the clearances of rules (18) and (19), NaN for (19) if the response without the damper has
        no peak; rm W^2 d0/f at the optimum, with the forcing amplitude f; and the fractions of
        the excess of this ratio over 1 that two corrections of (18) explain. The first replaces the
        1 by pi^2/8, from the first harmonic of a loose mass that flies at constant speed. The
        second is the theory of this straight flight between walls of finite stiffness. For each
        `edge` an end of the range of clearances in which max |Z1| is within 10 % of its minimum.
        The attribute `optimum` is a sentence on the optimum, or says that there is no quiet motion.

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
    parameters = np.array([pack(oscillator, each, frequency) for each in dampers])
    systems = [(each, frequency) for each in dampers]
    search = search_starts(oscillator, systems, starts, radius, seed, settling)
    data = sweep(
        parameters,
        CLEARANCE,
        "clearance",
        search,
        settling,
        workers=workers,
        progress=progress,
    )
    forcing = oscillator.forcing_amplitude(frequency)
    inertia = dampers[0].mass_ratio * frequency**2
    branch = _quiet_branch(data, parameters, forcing / inertia)
    data |= (
        _quiet_table(branch)
        | minimum_table(branch)
        | analytical_table(oscillator, dampers, frequency)
    )
    data |= {
        "largest_displacement": _largest(data),
        "rule_clearance": forcing / inertia,
        "peak_rule_clearance": _peak_rule(oscillator, dampers[0].mass_ratio),
    }
    data |= excess_table(inertia * data["optimum_clearance"] / forcing, dampers[0])
    made = (
        describe(oscillator, settling)
        | {name: getattr(dampers[0], name) for name in sorted(SWEPT_WITH)}
        | {"frequency": frequency}
        | describe_search(starts, radius, seed)
    )
    coordinates = {
        "clearance": clearances,
        "component": list(COMPONENTS),
        "edge": ["lower", "upper"],
    }
    found = dataset(data, coordinates, made, "Largest displacement against clearance", model)
    return found.assign_attrs(optimum=_in_words(found))


def _peak_rule(oscillator, mass_ratio):
    """Return the clearance of rule (19); NaN if the response without damper has no peak."""
    try:
        return optimum_clearance(oscillator, mass_ratio)
    except ValueError:
        return np.nan


def _quiet_branch(data, parameters, rule):
    """Return the `Branch` of quiet motions nearest to the clearance `rule`.

    If there is no quiet motion, all states and displacements of the branch are NaN.
    """
    table = {
        name: data[name][1]
        for name in (
            "outcome",
            "period",
            "contacts",
            "asymmetry",
            "maximum_displacement",
            "branch",
            "state",
        )
    }
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

    Parameters
    ----------
    sweep : xarray.Dataset
        Returned by `stages.optimum.clearance_sweep`. In SI units the sentence gives the gap, the
        full play; otherwise the clearance, half of the gap.
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
