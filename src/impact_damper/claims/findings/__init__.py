"""Findings on the claims: sentences that say with numbers what the data show.

A function of this subpackage takes the evidence for one claim, its numbers as keyword arguments,
and returns sentences that are true whatever the verdict is.
"""
