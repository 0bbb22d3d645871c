"""Performance of a machine with a given damper: costs, transients, contact stiffness."""
