"""What a design promises, and whether starts that it has not seen keep to it."""

from impact_damper.data.datasets import flag
from impact_damper.design.labelled import labelled


def promise_dataset(task, kind, limit, deviations):
    """Return the promise of a design and the verdict of unseen starts.

    A design with a quiet gap promises that, at its nominal values, at least `task.share` of the
    starts over the band end quiet. A robust design promises this within all tolerances, provided
    that the samples of the tolerances confirm it.

    Parameters
    ----------
    task : Task
    kind : str
        Of `choose.Choice`.
    limit : float
        Largest displacement of a quiet motion, mm.
    deviations : xarray.Dataset
        Samples of the tolerances; unseen starts at the nominal values and at corners.
    """
    samples, unseen = (
        deviations[name].sel(bound="share").values for name in ("sample_share", "corner_share")
    )
    robust = kind == "robust" and bool((samples >= task.share).all())
    if kind == "least_worst":
        verdict = "none_made"
    elif robust:
        verdict = "robust_kept" if (unseen >= task.share).all() else "broken"
    else:
        verdict = "nominal_kept" if unseen[0] >= task.share else "broken"
    return labelled({"promise": flag("promise", verdict), "promised_displacement": limit})
