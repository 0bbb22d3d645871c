"""The integrators and models compared with the library's Taylor series, and their errors."""
