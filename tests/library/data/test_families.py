"""Motions of a sweep with the same branch number are one motion."""

import numpy as np
from helpers.made_up import matched_sweep

from impact_damper.data.sweeps import families


def test_motions_over_a_sweep():
    found = families(matched_sweep())
    assert [each[:2] for each in found] == [("chaotic", 0), ("settled", 1), ("settled", 3)]
    assert [each.starts for each in found] == [16, 14, 0]
    row, column = np.nonzero(found[0].places)
    assert row.tolist() == [0, 1, 2] and column.tolist() == [1, 0, 0]
    assert np.sum([each.places for each in found]) == 6
