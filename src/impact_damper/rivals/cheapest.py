"""The cheapest method or model that meets the accuracy which a scene states."""

import numpy as np

from impact_damper.data.datasets import flag

SCIPY = ("DOP853", "LSODA", "Radau")
METHODS = (
    "taylor",
    "merson_kink",
    "merson_located",
    *(f"{name}_{mode}" for name in SCIPY for mode in ("kink", "located")),
    "rigid",
    "rigid_mended",
    "rigid_balance",
    "full_balance",
    "many_harmonics",
    "shooting",
)


def choice(data, methods=METHODS):
    """Number of the run with the least work that meets the accuracy; None if none does."""
    meets = (data["meets_accuracy"].values == flag("meets_accuracy", "yes")) & np.isin(
        data["method"].values, methods
    )
    work = np.where(meets, data["operations"].values, np.inf)
    return int(np.argmin(work)) if meets.any() else None


def loosest_tolerance(data):
    """The tolerance of the Taylor series from which on all tighter ones meet the accuracy, or None.

    It is the one with the least work of those.
    """
    of = data["method"].values == "taylor"
    tolerances = data["setting"].values[of]
    meets = data["meets_accuracy"].values[of] == flag("meets_accuracy", "yes")
    order = np.argsort(tolerances)
    held = np.cumprod(meets[order]).astype(bool)
    return float(tolerances[order][held].max()) if held.any() else None
