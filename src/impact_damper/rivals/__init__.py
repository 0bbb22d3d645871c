"""Integrators and models from other sources, compared with the integrator of this package.

The integrator of this package is the event-driven Taylor series. An integrator goes "through the
kink" if it does not locate contacts. The force has a kink where a contact begins or ends, and the
steps of such an integrator do not end there.
"""
