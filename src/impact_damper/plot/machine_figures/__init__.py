"""Figures of one machine and the damper designed for it.

The page of a machine shows all of them but `overview`, a figure of the report with all machines.
"""
