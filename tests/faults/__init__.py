"""Trials of what may go wrong with a run: `make faults`."""
