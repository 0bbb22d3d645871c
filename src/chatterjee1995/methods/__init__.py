"""Integrators and models from other sources, compared with the integrator of this package.

The integrator of this package takes steps by Taylor series and ends a step where a contact begins
or ends. There the force has a kink or a jump. An integrator goes "through the kink" if it does not
locate contacts, so that its steps do not end there.
"""
