"""Figures, one function for each kind. A figure only draws: all numbers come from datasets."""
