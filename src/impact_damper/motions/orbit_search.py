"""Find stable orbits by Newton's method, in addition to the motions found by runs from starts.

Some stable orbits attract so few states that hardly any random start leads to them. On most of
these orbits the primary mass moves nearly as in another motion of the same system, while the loose
mass moves differently. Therefore the first guesses of Newton's method have the primary mass on a
known motion and the loose mass anywhere in the gap.

Symbols are as in `system.parameters`.
"""

import numpy as np

from impact_damper.model.packed import CLEARANCE
from impact_damper.motions import ensemble
from impact_damper.motions.strobe_map import distance, flow, polish, strobe_time

# Longest period of an orbit, in forcing cycles.
LONGEST = 5
# Largest distance of an orbit from its start, divided by the largest |Z1| or |Z1'| of the known
# motions at the strobe, or by the clearance if the clearance is larger. With twice this distance
# Newton's method takes four times as long and finds hardly more orbits.
REACH = 1.0
# Two orbits are the same if their states differ by less than SAME.
SAME = 1e-6


def add_orbits(catalogues, loose, settling, workers) -> None:
    """Enter the orbits that `stable_orbits` finds into the catalogues of known motions.

    Parameters
    ----------
    catalogues : list of catalogue.Catalogue
        Motions known at each value of the swept parameter.
    loose : list of numpy.ndarray
        Argument `loose` of `stable_orbits` at each value.
    settling : Settling
    workers : int
        Number of threads. The result does not depend on it.
    """
    found, stop = [np.empty((0, 4))] * len(catalogues), np.zeros(1, bool)

    def work(part):
        for k in range(part.start, part.stop):
            records = [
                each for each in catalogues[k].records if np.isfinite(each["maximum_displacement"])
            ]
            motions = np.array([each["state"][:2] for each in records])
            found[k] = stable_orbits(catalogues[k].p, motions, loose[k], settling.tolerance, stop)

    ensemble.run_chunks(work, len(catalogues), workers, None, stop, size=1)
    for catalogue, states in zip(catalogues, found, strict=True):
        rows = np.tile(catalogue.p, (len(states), 1))
        for record in ensemble.settle(rows, states, settling, from_strobe=True):
            catalogue.add(record, "followed")


def stable_orbits(p, motions, loose, tolerance, stop) -> np.ndarray:
    """Return states at the strobe (W T = pi/2), shape (k, 4), on stable orbits with contacts.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters.
    motions : array, shape (m, 2)
        Z1 and Z1' of known motions at the strobe.
    loose : array, shape (n, 2)
        Z2, and velocity Z1' - Z2' of the loose mass, of each start. The primary mass of start k is
        on known motion k modulo m.
    tolerance : float
        Largest local error of a step.
    stop : array of bool, shape (1,)
        Another thread may set this flag to end the search.
    """
    found, none = [], np.empty((0, 4))
    if len(motions) == 0 or len(loose) == 0:
        return none
    reach = REACH * max(np.max(np.abs(motions)), p[CLEARANCE])
    primary = np.resize(motions, loose.shape)
    starts = np.column_stack([primary, loose[:, 0], primary[:, 1] - loose[:, 1]])
    for periods in range(1, LONGEST + 1):
        for start in starts:
            if stop[0]:
                return none
            state = start.copy()
            converged, _, multiplier = polish(p, state, periods, reach, tolerance)
            if not converged or not abs(multiplier) < 1:
                continue
            if any(distance(state, each, 1.0) < SAME for each in found):
                continue
            run = state.copy()
            contacts, _ = flow(p, run, none, strobe_time(p), periods, np.bool_(False), tolerance)
            if contacts:
                found.append(state)
    return np.array(found).reshape(-1, 4)
