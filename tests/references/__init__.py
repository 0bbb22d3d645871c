"""Independent references: 80-bit arithmetic in C, heyoka.py, and stored results of AUTO-07p."""
