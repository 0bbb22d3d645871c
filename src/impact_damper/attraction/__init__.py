"""Basins of attraction: the motion that each state leads to, and the boundaries between basins."""
