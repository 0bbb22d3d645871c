"""Methods that others use for this problem, to be compared with the event-driven Taylor series."""
