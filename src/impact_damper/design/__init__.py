"""Design of an impact damper for a machine, in SI units."""
