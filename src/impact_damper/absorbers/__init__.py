"""Tuned absorbers on a machine: a small mass on a spring and a dashpot.

Tuned absorbers are the usual alternative to an impact damper of the same mass. Their spring is
linear or has a cubic term.
"""
