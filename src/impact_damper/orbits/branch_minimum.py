"""Minimum of the largest displacement along a branch of motions over the clearance."""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from impact_damper.data.datasets import flag
from impact_damper.model.packed import CLEARANCE
from impact_damper.motions.following import RESOLUTION, follow_stable
from impact_damper.motions.records import measured
from impact_damper.motions.strobe_map import POLISH_TOLERANCE

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
