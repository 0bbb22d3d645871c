"""Figures, one module for each kind. A figure only draws: all numbers come from datasets."""
