"""Match motions that settle on no orbit from one value of a swept parameter to the next.

A motion that settles keeps its identity because its orbit is followed by Newton's method
(`motions.sweep`). Chaotic and quasi-periodic motions, and those without contact, are matched by
what they have in common: outcome, period and size, the closest sizes first, one to one. A chaotic
motion may be small for as long as it is measured. It is then known by how far it reached in the
second half of its run.
"""

import math

from impact_damper.data.datasets import is_settled

# Motions that have not settled are the same if their sizes differ by a smaller factor.
SIMILAR = 1.5


def match_unsettled(first, second) -> list:
    """Return pairs of indices of motions at neighbouring values that are the same motion.

    Parameters
    ----------
    first, second : list of records.MOTION
        Motions at the two values.

    Returns
    -------
    list of (int, int)
        Each motion is in one pair at most.
    """
    pairs = sorted(
        (ratio, i, j)
        for i, one in enumerate(first)
        for j, other in enumerate(second)
        if not is_settled(one)
        and one["outcome"] == other["outcome"]
        and one["period"] == other["period"]
        and (ratio := size_ratio(one, other)) < SIMILAR
    )
    matched = []
    for _, i, j in pairs:
        if all(i != k and j != m for k, m in matched):
            matched.append((i, j))
    return matched


def size_ratio(one, other):
    """Return the larger of the sizes of two motions divided by the smaller one.

    The size is max |Z1|. Of motions without a period it is how far they reached, if these distances
    are closer; in a free decay these distances are 0. The ratio is 1 if both motions are infinite,
    or both are at rest.

    Parameters
    ----------
    one, other : records.MOTION
        Of the same period.
    """
    if one["maximum_displacement"] == other["maximum_displacement"]:
        return 1.0
    names = ["maximum_displacement"] if one["period"] else ["maximum_displacement", "reach"]
    pairs = [sorted((float(one[name]), float(other[name]))) for name in names]
    return min(_ratio(larger, smaller) for smaller, larger in pairs)


def _ratio(larger, smaller):
    if larger == smaller:
        return 1.0
    return larger / smaller if smaller else math.inf
