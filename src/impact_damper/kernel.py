"""The event-driven flow: one certified Taylor step, in flight or in contact.

A step takes the state (Z1, Z1', Z2, Z2'), the tangents and the wall that the
loose mass touches (`side`: -1, 0 in flight, +1) to the next event or to the end
of the step, whichever is first. Events are the beginning and the end of contacts.
The absence of an event is certified by a bound on the second derivative of the
gap over the step; the same bound marches to the first root without passing it.
"""

import math

import numpy as np

from impact_damper.accelerate import inlined, kernel
from impact_damper.series import (
    CONTACT_ORDER,
    FLIGHT_ORDER,
    LENGTH,
    contact,
    contact_tangent,
    flight,
    flight_tangent,
)

ROUNDING = 2.0**-50
# Share of the contact's natural period that a step may take. A contact lasts half a period:
# a series beyond that is cut at the release, and only loosens the bound that certifies it.
CONTACT_CAP = 0.4
TINY = 1e-300
# Local errors pass through contacts, which amplify them; this share of the tolerance
# keeps the error of settled motions within 10 times of it.
SAFETY = 0.05
CURVATURE = tuple(float(k * (k - 1)) for k in range(LENGTH))


@kernel
def workspace():
    """Arrays for the series of one step, shape (5, LENGTH): Z1, Z2, Z1^2 and two tangents."""
    return np.zeros((5, LENGTH))


@kernel
def polynomial(c, order, t):
    """Value and first derivative of a polynomial at t."""
    value = c[order]
    slope = 0.0
    for k in range(order - 1, -1, -1):
        slope = slope * t + value
        value = value * t + c[k]
    return value, slope


@kernel
def curvature_bound(c, order, length):
    """Bound on the second derivative of a polynomial over [0, length]."""
    bound = 0.0
    for k in range(order, 1, -1):
        bound = bound * length + CURVATURE[k] * abs(c[k])
    return bound


@kernel
def step_length(c, order, tolerance):
    """Length of a step whose last two terms stay well below the tolerance, in the slope too."""
    tolerance *= SAFETY
    last = math.log(tolerance / (order * abs(c[order]) + TINY)) / (order - 1)
    before = math.log(tolerance / ((order - 1) * abs(c[order - 1]) + TINY)) / (order - 2)
    return math.exp(min(last, before))


@kernel
def safe_advance(gap, closing, bound):
    """Time within which a gap that closes at a given speed cannot vanish.

    First root of gap - closing t - bound t^2/2, with bound on the second derivative.
    """
    root = math.sqrt(closing * closing + 2.0 * bound * max(gap, 0.0))
    if closing > 0.0:
        return 2.0 * max(gap, 0.0) / (closing + root)
    return (root - closing) / (bound + TINY)


@kernel
def first_contact(c, order, offset, drift, clearance, length):
    """First time in [0, length) at which |Z2| reaches the clearance from inside.

    Z2 is the polynomial plus offset + drift t. Returns the time and the side, or
    (length, 0) when there is certainly none.
    """
    if clearance == math.inf:
        return length, 0
    bound = curvature_bound(c, order, length)
    precision = ROUNDING * clearance
    # From a wall that recedes, a penetration within so short a time is below rounding.
    shortest = math.sqrt(8.0 * precision / (bound + TINY))
    t = 0.0
    z, w = c[0] + offset, c[1] + drift
    while True:
        upper = safe_advance(clearance - z, w, bound)
        lower = safe_advance(clearance + z, -w, bound)
        side = 1 if upper < lower else -1
        if side * w > 0.0:
            ahead = min(upper, lower)
            if clearance - side * z <= precision or t + ahead == t:
                return t, side
        else:
            ahead = max(min(upper, lower), shortest, ROUNDING * t)
        t += ahead
        if not t < length:
            return length, 0
        z, w = polynomial(c, order, t)
        z += offset + drift * t
        w += drift


@kernel
def first_release(c, order, side, length):
    """First time in [0, length) at which the penetration returns to zero, and whether it does."""
    bound = curvature_bound(c, order, length)
    precision = ROUNDING * (abs(c[0]) + abs(c[1]) * length)
    t = 0.0
    q, w = side * c[0], side * c[1]
    while True:
        ahead = safe_advance(q, -w, bound)
        if w <= 0.0 and (q <= precision or t + ahead == t):
            return t, True
        t += ahead
        if not t < length:
            return length, False
        q, w = polynomial(c, order, t)
        q *= side
        w *= side


@kernel
def dashpot_jump(p, tangent, direction):
    """Jump of a tangent where the dashpot's force sets in (-1) or ends (+1).

    Saltation across Z2 = +-d0: only the force is discontinuous, so the jump is linear in
    the relative displacement, does not depend on the speed, and has determinant 1.
    """
    jump = direction * p[6] * tangent[2]
    tangent[1] += jump
    tangent[3] += jump * (1.0 + p[5])


@inlined
def flight_step(p, y, tangents, t, longest, tolerance, work):
    """One step in flight. Returns its length and the side on which a contact begins, or 0."""
    x, square, dx = work[0], work[2], work[3]
    angle = p[0] * t
    flight(p, math.cos(angle), math.sin(angle), y[0], y[1], x, square)
    scale = max(1.0, abs(y[0]), abs(y[1]))
    length = min(longest, step_length(x, FLIGHT_ORDER, tolerance * scale))
    offset = y[2] - y[0]
    drift = y[3] - y[1]
    length, side = first_contact(x, FLIGHT_ORDER, offset, drift, p[3], length)
    y[0], y[1] = polynomial(x, FLIGHT_ORDER, length)
    y[2] = side * p[3] if side != 0 else y[0] + offset + drift * length
    y[3] = y[1] + drift
    for i in range(tangents.shape[0]):
        d = tangents[i]
        offset = d[2] - d[0]
        drift = d[3] - d[1]
        flight_tangent(p, square, d[0], d[1], dx)
        d[0], d[1] = polynomial(dx, FLIGHT_ORDER, length)
        d[2] = d[0] + offset + drift * length
        d[3] = d[1] + drift
        if side != 0 and p[6] > 0.0:
            dashpot_jump(p, d, -1.0)
    return length, side


@inlined
def contact_step(p, y, tangents, side, t, longest, tolerance, work):
    """One step in contact. Returns its length and the side after it: 0 if the contact ended."""
    x, q, square, dx, dq = work[0], work[1], work[2], work[3], work[4]
    angle = p[0] * t
    contact(p, math.cos(angle), math.sin(angle), y[0], y[1], y[2] - side * p[3], y[3], x, q, square)
    scale = max(1.0, abs(y[0]), abs(y[1]), abs(y[3]))
    length = min(
        longest,
        CONTACT_CAP * 2.0 * math.pi / math.sqrt(p[4] * (1.0 + p[5])),
        step_length(q, CONTACT_ORDER, tolerance * scale),
        step_length(x, CONTACT_ORDER, tolerance * scale),
    )
    length, released = first_release(q, CONTACT_ORDER, side, length)
    y[0], y[1] = polynomial(x, CONTACT_ORDER, length)
    penetration, y[3] = polynomial(q, CONTACT_ORDER, length)
    y[2] = side * p[3] if released else side * p[3] + penetration
    for i in range(tangents.shape[0]):
        d = tangents[i]
        contact_tangent(p, square, d[0], d[1], d[2], d[3], dx, dq)
        d[0], d[1] = polynomial(dx, CONTACT_ORDER, length)
        d[2], d[3] = polynomial(dq, CONTACT_ORDER, length)
        if released and p[6] > 0.0:
            dashpot_jump(p, d, 1.0)
    return length, 0 if released else side


@kernel
def step(p, y, tangents, side, t, longest, tolerance, work):
    """One step of the flow, ended early by an event.

    Parameters
    ----------
    p : array, shape (7,)
        Packed parameters (`parameters.pack`).
    y : array, shape (4,)
        Z1, Z1', Z2, Z2'; replaced.
    tangents : array, shape (m, 4)
        Solutions of the variational equations, m may be 0; replaced.
    side : int
        Wall in contact, -1 or 1, or 0 in flight.
    t, longest, tolerance : float
        Time (only its forcing phase counts), longest step, local error allowed.
    work : array
        `workspace()`; row 0 holds the series of Z1 over the step afterwards.

    Returns
    -------
    length : float
        Time gone by.
    side : int
        Wall in contact after the step.
    """
    if side == 0:
        return flight_step(p, y, tangents, t, longest, tolerance, work)
    return contact_step(p, y, tangents, side, t, longest, tolerance, work)


@kernel
def side_of(p, y):
    """Wall in contact in a state: beyond it, or on it and moving outward."""
    if y[2] > p[3] or (y[2] == p[3] and y[3] > 0.0):
        return 1
    if y[2] < -p[3] or (y[2] == -p[3] and y[3] < 0.0):
        return -1
    return 0


@kernel
def advance(p, y, tangents, side, t, end, tolerance, work):
    """Integrate from t to end. Returns the side after it, contacts begun and time in contact."""
    contacts = 0
    touching = 0.0
    while t < end:
        before = side
        length, side = step(p, y, tangents, side, t, end - t, tolerance, work)
        t = end if length >= end - t else t + length
        if before == 0 and side != 0:
            contacts += 1
        if before != 0:
            touching += length
    return side, contacts, touching
