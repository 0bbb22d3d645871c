"""Integrators and models that others use for this problem, to be compared with our integrator.

Ours is the event-driven Taylor series. "Through the kink" means without locating contacts: the
force has a kink where a contact begins or ends, and the steps of the integrator do not end there.
"""
