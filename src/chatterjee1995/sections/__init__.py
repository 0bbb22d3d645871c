"""Sections of the configuration, by subject: their keys, bounds, and parameters of jobs."""
