"""Figures of one machine and the damper designed for it.

The page of a machine shows all of these figures, and the chapter of the report two.
"""
