"""Growth of a tangent along a motion, from which the largest Lyapunov exponent follows.

A tangent is a solution of the variational equations. The logarithm of its growth is summed over
batches of forcing cycles. The scatter of the batches gives the standard error.
"""

import math

from impact_damper.kernel.compiling import kernel, kernel_only

# BLOCK   forcing cycles of a batch
# RECENT  number of last batches in which the tangent must grow
BLOCK = 10
RECENT = 5


@kernel_only
def follow_tangent(tangent, growth):
    """Normalise a tangent after a forcing cycle, and add the logarithm of its growth to the batch.

    `growth` has the fields `periods` to `recent` of `watch.SEEN`. Mean and sum of squares over
    complete batches are updated by Welford's recurrence.
    """
    size = 0.0
    for i in range(4):
        size += tangent[i] ** 2
    size = math.sqrt(size)
    for i in range(4):
        tangent[i] /= size
    growth.batch += math.log(size)
    growth.periods += 1
    if growth.periods % BLOCK == 0:
        count = growth.periods // BLOCK
        change = growth.batch - growth.mean
        growth.mean += change / count
        growth.squares += change * (growth.batch - growth.mean)
        growth.recent[count % RECENT] = growth.batch
        growth.batch = 0.0


@kernel
def exponent(growth):
    """Return the mean growth in a batch, its standard error, and whether the growth continues.

    The growth is a natural logarithm. It continues if its average over the last RECENT batches
    exceeds half its mean over all batches.
    """
    count = growth.periods // BLOCK
    recent = 0.0
    for i in range(RECENT):
        recent += growth.recent[i] / RECENT
    error = math.sqrt(growth.squares / (count * (count - 1.0)))
    return growth.mean, error, recent > 0.5 * growth.mean
