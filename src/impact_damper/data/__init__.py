"""Labelled datasets, the registry of their variables, and their files."""
