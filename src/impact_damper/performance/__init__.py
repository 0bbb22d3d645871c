"""Behaviour of a machine with a given damper: costs of a motion, transients, contact stiffness."""
