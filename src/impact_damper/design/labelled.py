"""Datasets (xarray) of the steps of a design, in mm, Hz, N and multiples of nominal values.

A quiet motion stays below the quiet limit, a bound on the displacement. The quiet orbit is the
symmetric periodic motion for which a damper is designed. A start is a random initial state. The
classes that are turned into datasets here explain their attributes.
"""

import numpy as np
import xarray as xr

from impact_damper.data.datasets import SOURCE, flag, shown_variable
from impact_damper.data.shares import BOUNDS
from impact_damper.design.choose import Comparison
from impact_damper.design.masses import is_best
from impact_damper.design.tolerances import VARIED

# Ends of a range or of a confidence interval.
SIDES = ["lower", "upper"]


def labelled(values, **coordinates) -> xr.Dataset:
    """Return a dataset of registered variables, which have units and descriptions."""
    made = {name: shown_variable(name, value) for name, value in values.items()}
    known = {name: shown_variable(name, value) for name, value in coordinates.items()}
    return xr.Dataset(made, known, {"source": SOURCE})


def screening_dataset(task, screening) -> xr.Dataset:
    """Return a `screen.Screening` as a dataset."""
    best = screening.best
    values = {
        "worst_frequency": task.worst_frequency,
        "balance_displacement": task.bare,
        "orbit_limit": screening.limit,
        "flight_gap": screening.rule_gap,
        "manifold_gap": screening.manifold_gap,
        "screened_displacement": screening.displacement,
        "screened_modulus": screening.modulus,
        "best_orbit_frequency": best.frequency,
        "best_orbit_gap": best.gap,
        "best_orbit_displacement": best.displacement,
        "best_orbit_modulus": best.modulus,
        "best_orbit_edge": best.edge,
        "best_orbit_status": flag("best_orbit_status", best.status),
        "screen_motions": screening.motions,
        "screen_orbits": np.sum(np.isfinite(screening.modulus)),
    }
    return labelled(values, frequency=task.grid, screened_gap=screening.gaps)


def restitutions_dataset(trials) -> xr.Dataset:
    """Return a `restitutions.Trials`, the best gap for each restitution, as a dataset."""
    values = {
        "tried_gap": trials.gap,
        "tried_displacement": trials.worst,
        "tried_choice": [flag("tried_choice", kind) for kind in trials.kind],
    }
    return labelled(values, tried_restitution=trials.restitution)


def comparison_dataset(coarse, candidates) -> xr.Dataset:
    """Return the coarse comparison of gaps and that of the candidates as a dataset."""
    values = {
        "displacement_limit": candidates.limit,
        "coarse_displacement": coarse.worst,
        "coarse_share": coarse.least_share,
        "compared_motions": sum(each.numbers["start_count"].sum() for each in (coarse, candidates)),
        **candidates.numbers,
    }
    return labelled(
        values,
        coarse_gap=coarse.gaps,
        candidate_gap=candidates.gaps,
        frequency=candidates.frequencies,
        side=SIDES,
    )


def comparison_of(data, task) -> Comparison:
    """Return the comparison of the candidates that `comparison_dataset` stored in `data`."""
    names = [
        name
        for name, values in data.data_vars.items()
        if values.dims[:2] == ("candidate", "frequency")
    ]
    return Comparison(
        data["candidate_gap"].values,
        data["frequency"].values,
        {name: data[name].values for name in names},
        float(data["displacement_limit"]),
        task.share,
    )


def cliff_dataset(choice, edges, lives) -> xr.Dataset:
    """Return a dataset of the chosen gap, the ends of the quiet gaps, and lives of chaotic motions.

    Parameters
    ----------
    choice : choose.Choice
    edges : tuple of cliff.Edge
    lives : cliff.Lives or None
    """
    values = {
        "design_gap": choice.gap,
        "design_choice": flag("design_choice", choice.kind),
        "cliff_gap": [edge.gap for edge in edges],
        "cliff_beyond": [edge.beyond for edge in edges],
        "cliff_status": [edge.status for edge in edges],
        "cliff_frequency": [edge.frequency for edge in edges],
    }
    gaps = np.empty(0)
    if lives is not None:
        gaps = lives.gaps
        values |= {"life_share": lives.share, "life_rate": lives.rate}
    return labelled(values, side=SIDES, life_gap=gaps, bound=BOUNDS)


def branch_dataset(task, found, parameter) -> xr.Dataset:
    """Return a branch, the curve of quiet orbits over a parameter, as a dataset.

    It includes the values of the parameter between which the orbit is stable.

    Parameters
    ----------
    task : Task
    found : cliff.QuietBranch or None
    parameter : str
        "gap" (the branch holds its logarithm) or "force".
    """
    place, event = f"{parameter}_of_orbit", f"stability_{parameter}_event"
    if found is None:
        values = dict.fromkeys(
            (place, f"displacement_by_{parameter}", f"modulus_by_{parameter}"), np.empty(0)
        )
        values[f"stability_{parameter}"] = np.full(2, np.nan)
        return labelled(values | {event: [flag(event, "no_orbit")] * 2}, side=SIDES)

    def shown(values):
        if parameter == "force":
            return values / found.nominal
        return 2e3 * task.scales.to_si(np.exp(values), "clearance")

    sizes = np.array([abs(point.orbit.multipliers[0]) for point in found.branch.points])
    ends = sorted(_stability_end(found, step) for step in (-1, 1))
    values = {
        place: shown(found.branch.values),
        f"displacement_by_{parameter}": task.millimetres(found.branch.displacements),
        f"modulus_by_{parameter}": sizes,
        f"stability_{parameter}": shown(np.array([value for value, _ in ends])),
        event: [flag(event, name) for _, name in ends],
    }
    return labelled(values, side=SIDES)


def _stability_end(found, step):
    """Return where, and by which event, stability is first lost along a branch from its start.

    The first result is the parameter of the branch. `step` is -1 or 1, the direction.
    """
    branch, k = found.branch, found.start
    events = {place: event.kind for place, event in branch.events}
    while 0 <= k + step < len(branch.points):
        k += step
        if events.get(k) in ("fold", "symmetry_breaking", "neimark_sacker"):
            return branch.values[k], events[k]
    end = branch.ends[0 if step < 0 else 1]
    return branch.values[k], "range_ends" if end == "range_ends" else "branch_ends"


def dependence_dataset(dependence) -> xr.Dataset:
    """Return a `refine.Dependence`, derivatives of the quiet orbit, as a dataset."""
    values = {
        "displacement_change": dependence.displacement,
        "modulus_change": dependence.modulus,
    }
    return labelled(values, changed=dependence.names)


def deviations_dataset(samples, unseen, promise, limit) -> xr.Dataset:
    """Return the tests of a design with deviating values as a dataset.

    Parameters
    ----------
    samples, unseen : deviations.Cloud
        Motions at samples of the tolerances, and motions from new starts.
    promise : str
        Result of `deviations.promise`.
    limit : float
        Quiet limit, mm.
    """
    values = {"promise": flag("promise", promise), "promised_displacement": limit}
    for prefix, cloud in (("sample", samples), ("corner", unseen)):
        values |= {
            f"{prefix}_factor": cloud.factors,
            f"{prefix}_displacement": cloud.worst,
            f"{prefix}_share": cloud.share,
            f"{prefix}_least_share": cloud.least,
        }
    return labelled(values, varied=list(VARIED), bound=BOUNDS)


def masses_dataset(found) -> xr.Dataset:
    """Return a list of `masses.Alternative`, dampers of other masses, as a dataset.

    The dampers are sorted by rising mass.
    """
    found = sorted(found, key=lambda each: each.task.mass)
    masses = np.array([each.task.mass for each in found])
    costs = np.array([(each.worst, each.force) for each in found])
    values = {
        "other_gap": [each.gap for each in found],
        "other_displacement": costs[:, 0],
        "other_share": [each.share for each in found],
        "other_force": costs[:, 1],
        "other_best": is_best(masses, costs),
    }
    return labelled(values, other_mass=masses)
