"""A catalogue of the distinct motions at one value of a swept parameter.

Z1 is the displacement of the primary mass.
"""

import numpy as np

from impact_damper.data.datasets import flag, is_settled
from impact_damper.motions.matching import SIMILAR, size_ratio

# Records of equal outcome, period and contacts per cycle are one motion if max |Z1| differs
# relatively by less than SAME. Records of equal outcome and period that are not settled are one
# motion too if their sizes are similar (`matching.SIMILAR`). A motion is symmetric if its asymmetry
# is below SAME.
SAME = 1e-6
# A difference of max |Z1| below ROUNDING never separates two motions: for motions near rest,
# rounding errors exceed SAME times max |Z1|.
ROUNDING = 1e-11
# Two records of equal period are one motion if both have the same of these outcomes, in which the
# displacement is infinite or 0.
ALIKE = tuple(flag("outcome", name) for name in ("diverged", "escaped", "at_rest"))


class Catalogue:
    """Distinct motions at one value of the swept parameter.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters.
    numbering : iterator of int
        Numbers for new motions.

    Attributes
    ----------
    records : list of records.MOTION
        One record for each motion.
    numbers : list of int
        Numbers of the motions, unique over the sweep.
    origins : list of int
        Flags of `origin`, which state whether each motion was first found from a random start, from
        a placed start (`start_states`), or by Newton's method.
    starts : list of int
        For each motion the number of random starts that lead to it.
    """

    def __init__(self, p, numbering):
        self.p = p
        self.numbering = numbering
        self.records, self.numbers, self.origins, self.starts = [], [], [], []

    def find(self, record):
        """Return the index of a known motion that equals a record or its mirror image, or None."""
        for i, known in enumerate(self.records):
            if known["outcome"] != record["outcome"] or known["period"] != record["period"]:
                continue
            if record["outcome"] in ALIKE:
                return i
            size = known["maximum_displacement"]
            near = abs(record["maximum_displacement"] - size) < max(SAME * size, ROUNDING)
            near = near and abs(record["contacts"] - known["contacts"]) < 1e-9
            if near or (not is_settled(record) and size_ratio(record, known) < SIMILAR):
                return i
        return None

    def add(self, record, origin):
        """Return the index of a motion, and enter it if it is new.

        A new record of a known motion replaces the old record if its max |Z1| is larger by more
        than SAME.
        """
        i = self.find(record)
        if i is None:
            i = len(self.records)
            self.records.append(record)
            self.numbers.append(next(self.numbering))
            self.origins.append(flag("origin", origin))
            self.starts.append(0)
        elif record["maximum_displacement"] > self.records[i]["maximum_displacement"] + SAME:
            self.records[i] = record
        self.starts[i] += origin == "random_start"
        return i

    def order(self):
        """Return the indices of the motions by descending max |Z1|."""
        return np.argsort([record["maximum_displacement"] for record in self.records])[::-1]
