"""Tuned absorbers on a machine: a small mass on a spring and a dashpot.

They are what else one could build in place of an impact damper of the same mass. The spring is
linear or has a cubic term.
"""
