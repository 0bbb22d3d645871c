"""Helpers of the tests: known systems and orbits, invented datasets, copies of the project."""
