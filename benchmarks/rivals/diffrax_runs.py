"""Motions by diffrax on the CPU: Dopri8 with events, compiled by JAX for all starts together.

A `while_loop` integrates from one event to the next, and `vmap` runs all starts side by side.
"""

import functools
from importlib.metadata import version as version_of

import numpy as np

from benchmarks.rivals import coefficients, lacks

STEPS = 10**6  # largest number of steps between two contacts


def obstacle():
    return lacks("diffrax", "diffrax")


def version():
    return f"diffrax {version_of('diffrax')}, JAX {version_of('jax')}"


def equations(p):
    """Return the functions of rates and root. `side` is 0 in flight, -1 or 1 at a wall."""
    import jax.numpy as jnp

    h, linear, cubic, amplitude, w, d0, wall, dashpot, heavy = coefficients(p)

    def rates(t, y, side):
        free = amplitude * jnp.cos(w * t) - h * y[1] - (linear + cubic * y[0] * y[0]) * y[0]
        pressed = wall * (y[2] - side * d0) + dashpot * y[3]
        force = jnp.where(side == 0, 0.0, pressed) if np.isfinite(d0) else 0.0
        return jnp.array([y[1], free - force, y[3], free - heavy * force])

    def beyond(t, y, args, **_):
        # The value is negative within a flight or contact, and crosses zero upwards at its end.
        return jnp.where(args == 0, 1.0, -1.0) * (jnp.abs(y[2]) - d0)

    return rates, beyond


@functools.cache
def _compiled(parameters, end, damped):
    """Return the compiled function of starts, begin and tolerance; `parameters` are bytes."""
    import diffrax
    import jax
    import jax.numpy as jnp
    import optimistix

    jax.config.update("jax_enable_x64", True)
    rates, beyond = equations(np.frombuffer(parameters))
    finder = optimistix.Newton(1e-14, 1e-14)
    settings = {
        "terms": diffrax.ODETerm(rates),
        "solver": diffrax.Dopri8(),
        "event": diffrax.Event(beyond, finder, direction=True) if damped else None,
        "max_steps": STEPS,
        "throw": False,
        "adjoint": diffrax.ForwardMode(),
    }

    def motion(start, begin, tolerance):
        control = diffrax.PIDController(rtol=tolerance, atol=tolerance)

        def phase(carried):
            t, y, side, contacts = carried
            given = {"t0": t, "t1": end, "dt0": None, "y0": y, "args": side}
            found = diffrax.diffeqsolve(**given, **settings, stepsize_controller=control)
            t, y = found.ts[-1], found.ys[-1]
            side = jnp.where(side == 0, jnp.sign(y[2]), 0.0)
            return t, y, side, contacts + ((side != 0) & (t < end))

        first = jnp.asarray(begin, float), start, jnp.asarray(0.0), jnp.asarray(0)
        _, y, _, contacts = jax.lax.while_loop(lambda c: c[0] < end, phase, first)
        return y, contacts

    return jax.jit(jax.vmap(motion, in_axes=(0, None, None)))


def prepare(scene, tolerance):
    compiled = _compiled(scene.parameters.tobytes(), float(scene.end), scene.components == 4)

    def run(starts):
        states, contacts = compiled(starts, scene.begin, tolerance)
        return np.asarray(states), np.asarray(contacts)

    return run
