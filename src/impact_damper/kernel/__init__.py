"""Kernels (numba): the equation of motion, integration steps, the search for contacts."""
