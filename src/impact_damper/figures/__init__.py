"""Figures of the paper: each function draws a dataset, or a scheme, and computes nothing."""
