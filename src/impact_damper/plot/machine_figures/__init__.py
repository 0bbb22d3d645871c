"""Figures of one machine and the damper designed for it."""
