"""How a machine does with a given damper: costs, transients, contact stiffness; in SI units."""
