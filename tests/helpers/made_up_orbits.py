"""Invented branches of periodic orbits, from closed forms."""

import numpy as np

from impact_damper.data.datasets import dataset, flag


def branch(frequency, size, *, stable=True, **others):
    """Return the columns of one branch, keyed by name.

    `size` is max |Z1|, the largest displacement of the primary mass. It is a scalar or an array
    over `frequency`, and so are `stable` and the other columns: `period` in forcing cycles,
    `contacts` of a period, `phase` of Z1 relative to Z2 in radians, `asymmetry`, which is 0 for a
    symmetric orbit, and `restitution`.
    """
    usual = {"period": 1, "contacts": 2.0, "phase": np.pi, "asymmetry": 0.0, "restitution": np.nan}
    given = {"size": size, "multiplier": np.where(stable, 0.5, 2.0)} | usual | others
    columns = {name: np.broadcast_to(value, np.shape(frequency)) for name, value in given.items()}
    return {"frequency": np.asarray(frequency, float)} | columns


def branches(*parts, folds=(), parameters):
    """Return the dataset of branches from `branch`, with `folds` as (number of branch, W, size)."""
    table = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    number = np.repeat(np.arange(len(parts)), [len(part["frequency"]) for part in parts])
    count = len(number)
    place, value, size = np.reshape(folds, (-1, 3)).T
    data = {
        "followed_value": table["frequency"],
        "orbit_branch": number,
        "orbit_displacement": table["size"],
        "orbit_amplitude": table["size"],
        "orbit_phase_relative": table["phase"],
        "orbit_phase_loose": np.pi - table["phase"],
        "orbit_multiplier_real": np.stack([table["multiplier"], np.zeros(count)], axis=1),
        "orbit_multiplier_imaginary": np.zeros((count, 2)),
        "orbit_contacts": table["contacts"],
        "orbit_asymmetry": table["asymmetry"],
        "orbit_restitution": table["restitution"],
        "orbit_stability": np.where(table["multiplier"] < 1, 1, -1),
        "orbit_status": np.zeros(count, int),
        "orbit_residual": np.zeros(count),
        "liouville_error": np.zeros(count),
        "branch_period": np.array([part["period"][0] for part in parts]),
        "branch_end": np.full((len(parts), 2), flag("branch_end", "closed")),
        "branch_met": np.full((len(parts), 2), -1),
        "branch_events_lost": np.zeros(len(parts), int),
        "event_branch": place.astype(int),
        "event_place": np.zeros(len(place), int),
        "event_kind": np.full(len(place), flag("event_kind", "fold")),
        "event_value": value,
        "event_displacement": size,
    }
    return dataset(data, {}, parameters, "made up")
