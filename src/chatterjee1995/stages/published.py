"""Numbers computed here compared with published numbers and closed forms.

Each group of numbers is compared by a function in the package `comparisons`; the published numbers
are in the package `literature`. All groups together take some ten seconds.

A start is an initial state.
"""

from chatterjee1995.comparisons.duffing import basin_shares, jump_frequencies
from chatterjee1995.comparisons.hertz import hertz_impacts
from chatterjee1995.comparisons.rigid_walls import rigid_walls
from chatterjee1995.comparisons.tuned_absorbers import nonlinear_absorbers, tuned_mass_dampers
from chatterjee1995.comparisons.vibro_impact import ring_down, vibro_impact
from impact_damper.data.datasets import dataset, flag
from impact_damper.model.bounds import shown
from impact_damper.model.settling import check_settling

# Names of the groups, with the functions that compare them.
GROUPS = {
    "rigid_walls": rigid_walls,
    "vibro_impact": vibro_impact,
    "ring_down": ring_down,
    "tuned_mass_dampers": tuned_mass_dampers,
    "nonlinear_absorbers": nonlinear_absorbers,
    "basin_shares": basin_shares,
    "jump_frequencies": jump_frequencies,
    "hertz_impacts": hertz_impacts,
}


def published(settings, *, seed=1995, settling=None):
    """Compare numbers computed by this package with published ones.

    Parameters
    ----------
    settings : dict
        Maps the key of each group in GROUPS to the arguments of its function, without seed and
        settling.
    seed : int
        Seed of the random starts.
    settling : Settling, optional
        How long and how accurately motions from random starts are run.

    Returns
    -------
    xarray.Dataset
        For each `comparison`: the published value, the value computed here, the publication, the
        reason for their difference; the exponent of the power of a parameter with which the
        difference falls; the computed value extrapolated to the limit in which the closed form
        holds; the standard error of the difference if both values are shares of random samples; and
        the expected size of the relative difference.

    Raises
    ------
    ArithmeticError
        If an orbit that a comparison needs is not found.
    TypeError, ValueError
        If a group is unknown, or an argument out of range.
    """
    settling = check_settling(settling)
    unknown = settings.keys() - GROUPS.keys()
    if unknown:
        raise ValueError(
            f"settings: unknown groups {shown(sorted(unknown))}; known: {', '.join(GROUPS)}"
        )
    found = []
    for name, given in settings.items():
        random = {"seed": seed, "settling": settling} if name == "basin_shares" else {}
        found += GROUPS[name](**given, **random)
    data = {
        "publication": [flag("publication", each.publication) for each in found],
        "published_value": [each.published for each in found],
        "our_value": [each.ours for each in found],
        "difference_reason": [flag("difference_reason", each.reason) for each in found],
        "difference_order": [each.order for each in found],
        "difference_error": [each.error for each in found],
        "limit_value": [each.limit for each in found],
        "expected_difference": [each.expected for each in found],
    }
    quantities = [each.quantity for each in found]
    parameters = {"settings": settings, "seed": seed}
    return dataset(data, {"comparison": quantities}, parameters, "Published numbers and ours")
