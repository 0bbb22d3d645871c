"""Growth of a tangent along a motion, from which its largest Lyapunov exponent follows.

The growth is summed over batches of periods, whose scatter gives the standard error.
"""

import math

from impact_damper.kernel.compiling import kernel, kernel_only

# Forcing periods of a batch, and number of recent batches that must still grow.
BLOCK = 10
RECENT = 5


@kernel_only
def follow_tangent(tangent, growth):
    """Normalise a tangent vector after a period; add the logarithm of its growth to the batch.

    Mean and sum of squares over complete batches, of BLOCK periods, follow Welford's recurrence.
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
    """Return mean growth of a batch, its standard error, and whether recent batches grow too.

    Recent batches grow if their average growth is above half the mean.
    """
    count = growth.periods // BLOCK
    recent = 0.0
    for i in range(RECENT):
        recent += growth.recent[i] / RECENT
    error = math.sqrt(growth.squares / (count * (count - 1.0)))
    return growth.mean, error, recent > 0.5 * growth.mean
