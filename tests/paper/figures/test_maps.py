"""Edges of the cells of maps lie halfway between values, on a logarithmic scale."""

import numpy as np
from numpy.testing import assert_allclose

from impact_damper.plot.maps import edges


def test_edges_of_a_grid_of_decades():
    assert_allclose(edges(10.0 ** np.arange(3)), 10.0 ** np.array([-0.5, 0.5, 1.5, 2.5]))


def test_edges_of_a_lone_cell():
    assert_allclose(edges([100.0]), 10.0 ** np.array([1.5, 2.5]))
