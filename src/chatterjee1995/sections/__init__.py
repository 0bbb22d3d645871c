"""Sections of the configuration: keys, bounds, and the parameters of the jobs, by subject."""
