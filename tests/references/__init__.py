"""Independent references for tests: 80-bit arithmetic in C, heyoka.py, and results of AUTO-07p."""
