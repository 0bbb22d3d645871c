"""A sentence on the optimum of a sweep of the clearance."""

from impact_damper.data.datasets import flag


def optimum_in_words(sweep) -> str:
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
