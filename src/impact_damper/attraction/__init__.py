"""Basins of attraction: what each state leads to, and where the boundaries between basins lie."""
