"""Match motions that do not settle to an orbit between neighbouring values of a swept parameter.

A settled motion is identified by following its orbit with Newton's method (`motions.sweep`).
Chaotic motions, quasi-periodic motions and motions without contact are matched in pairs if they
have the same outcome and period and similar sizes; pairs with the closest sizes are matched first.
A chaotic motion may be small during its measurement. Therefore the field `reach` of its record is
compared too, the largest distance from the origin at the strobe during the long run before.

Z1 is the displacement of the primary mass.
"""

import math

from impact_damper.data.datasets import is_settled

# Two motions that have not settled can be the same if the ratio of their sizes is below SIMILAR.
SIMILAR = 1.5


def match_unsettled(first, second) -> list:
    """Return the pairs of indices of motions at two neighbouring values that are the same motion.

    Parameters
    ----------
    first, second : list of records.MOTION
        Motions at the two values.

    Returns
    -------
    list of (int, int)
        Each motion is in at most one pair.
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
    """Return the ratio of the sizes of two motions, larger over smaller.

    The size is max |Z1|. For motions without a period the ratio of the fields `reach` is returned
    if it is closer to 1; in an unforced decay these fields are 0. The ratio is 1 if both motions
    are infinite, or if both are at rest.

    Parameters
    ----------
    one, other : records.MOTION
        Two motions of the same period.
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
