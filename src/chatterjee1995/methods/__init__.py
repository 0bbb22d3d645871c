"""Integrators and models that are compared with the Taylor series of the library."""
