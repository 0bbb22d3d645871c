"""The best clearance for migration and for suppression, at each mass ratio.

Suppression keeps the damper on, so that the motion stays small. This motion is called quiet.
Migration switches the damper on and off, until the motion without damper stays small by itself.
This motion is called the goal.
"""

import numpy as np


def best_clearances(one):
    """Return the best clearances for two purposes.

    The best clearance for migration has the largest share of trials that reach the goal, if the
    damper is switched off as soon as the measured state leads there (the policy "state"). Among
    equal shares, the smallest median of the cycles until the goal decides. The best clearance for
    suppression has the smallest quiet motion.

    Parameters
    ----------
    one : xarray.Dataset
        Of the stage `release_dampers`, for one frequency and restitution.

    Returns
    -------
    dict of numpy.ndarray, shape (mass ratios,)
        Keyed by "migration" and "suppression"; NaN where no clearance reaches the goal, or where
        there is no quiet motion.
    """
    state = one.sel(policy="state", bound="share").transpose("mass_ratio", "clearance", ...)
    success, cycles = state["damper_success"].values, state["damper_cycles"].values
    quiet = one["damper_quiet"].transpose("mass_ratio", "clearance").values
    order = np.lexsort((cycles, -success), axis=-1)[:, 0]
    smallest = np.argmin(np.where(np.isfinite(quiet), quiet, np.inf), axis=1)
    clearance = one["clearance"].values
    return {
        "migration": np.where(success.max(axis=1) > 0, clearance[order], np.nan),
        "suppression": np.where(np.isfinite(quiet).any(axis=1), clearance[smallest], np.nan),
    }
