"""Tuned absorbers on a machine: a small mass on a spring and a dashpot.

They are the usual alternative to an impact damper of the same mass. The spring is linear or has a
cubic term.
"""
