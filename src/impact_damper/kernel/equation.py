"""The equation of motion of the primary mass without the damper, and its Taylor series.

    Z1'' = (F + U W^2) cos(W T) - h Z1' - omega_l^2 Z1 - k3 Z1^3

This is equation (3) of the paper with three further parameters: k3, F and U. Some functions yield
lines of Python code, which `instances` joins into kernels: docs/explanation/series.md. These lines
use Taylor coefficients number k = 0, 1, ... of three functions: xk of Z1, qk of the depth in a wall
and gk of Z1'' without the wall's force.
"""

import math
from functools import partial

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    CUBIC,
    DAMPING,
    FORCE,
    FREQUENCY,
    GRAVITY,
    INVERSE_MASS_RATIO,
    LAG,
    STIFFNESS,
    UNBALANCE,
)


@kernel_only
def forcing_amplitude(p, lane=0, lanes=1):
    """Return the amplitude F + U W^2 of the forcing per unit of primary mass.

    `p` is a flat array with a row for each parameter. A row has one number for each of `lanes`
    trajectories. `lane` is the index of the trajectory whose amplitude is returned.
    """
    frequency = p[FREQUENCY * lanes + lane]
    return p[FORCE * lanes + lane] + p[UNBALANCE * lanes + lane] * frequency * frequency


@partial(kernel_only, fastmath=False)
def external_force(p, t):
    """Return the force of the excitation at the time t, divided by the primary mass."""
    # `fastmath=False` keeps LLVM from fusing this multiplication with an addition in the caller.
    return forcing_amplitude(p) * math.cos(p[FREQUENCY] * t)


@kernel_only
def spring(p, x, lane=0, lanes=1):
    """Return the spring's restoring force at Z1 = x. For p and `lane` see `forcing_amplitude`."""
    return (p[STIFFNESS * lanes + lane] + p[CUBIC * lanes + lane] * x * x) * x


@kernel_only
def spring_slope(p, x, lane=0, lanes=1):
    """Return the derivative of `spring` with respect to x."""
    return p[STIFFNESS * lanes + lane] + 3.0 * p[CUBIC * lanes + lane] * x * x


@kernel
def acceleration(p, y, t):
    """Return Z1'' without the damper's forces, in the state y = (Z1, Z1', Z2, Z2') at time t."""
    return external_force(p, t) - p[DAMPING] * y[1] - spring(p, y[0])


@kernel
def no_return(p):
    """Return the |Z1| beyond which an outward motion never comes back; infinity if k3 >= 0.

    At a large |Z1| a softening spring (k3 < 0) pushes outward. Where |Z1| > 2 omega_l/sqrt(-k3),
    the outward force is at least 3/4 of the spring's cubic part -k3 |Z1|^3. Let A be the amplitude
    of the forcing. Where |Z1| > (4 A/(-3 k3))^(1/3), 3/4 of the cubic part is at least A. The
    larger of both limits is returned. Forces of the loose mass are neglected.
    """
    if p[CUBIC] >= 0.0:
        return math.inf
    barrier = math.sqrt(p[STIFFNESS] / -p[CUBIC])
    return max(2.0 * barrier, (4.0 * abs(forcing_amplitude(p)) / (-3.0 * p[CUBIC])) ** (1.0 / 3.0))


@kernel_only
def has_escaped(p, x, v):
    """Return whether a motion with Z1 = x and Z1' = v moves outward beyond `no_return`."""
    return p[CUBIC] < 0.0 and not (abs(x) <= no_return(p) or x * v <= 0.0)


@kernel_only
def energy(p, y):
    """Return the kinetic plus the potential energy of both masses in the state y."""
    x, v = y[0], y[1]
    total = 0.5 * v * v + (0.5 * p[STIFFNESS] + 0.25 * p[CUBIC] * x * x) * x * x
    if p[INVERSE_MASS_RATIO] > 0.0:
        total += 0.5 * (v - y[3]) ** 2 / p[INVERSE_MASS_RATIO]
        depth = max(abs(y[2]) - p[CLEARANCE], 0.0)
        pushed = depth + p[LAG] * (y[3] if y[2] > 0.0 else -y[3]) > 0.0
        total += 0.5 * p[CONTACT_STIFFNESS] * depth * depth if pushed else 0.0
        total += p[GRAVITY] * (x - y[2]) / p[INVERSE_MASS_RATIO]
    return total


def coefficients(at):
    """Yield lines of code that load the coefficients of the spring's nonlinear terms.

    `at(name)` returns the code that reads the parameter `name`, one of `packed.NAMES`.
    """
    yield f"cubic = {at('CUBIC')}"


def beginning(at):
    """Yield code lines that set variables for `motion`. `at(name)` is code for a parameter."""
    yield from coefficients(at)
    yield "double = 2.0 * cubic"
    yield "s0 = cubic * x0 * x0"
    yield f"stiffness = {at('STIFFNESS')} + s0"
    yield "linear = stiffness + 2.0 * s0"


def motion(order, phase, constants, across):
    """Yield lines of code that compute the Taylor series of Z1 in a step, up to `order`.

    If `phase` is "contact" (not "flight"), the lines also compute the series of the depth in the
    wall. The lines read the variables that `beginning` defines, and these:

    x0, x1, q0, q1     at the beginning of the step: Z1 and Z1', in contact the depth and its rate
    cosine, sine       at the beginning of the step: (F + U W^2) cos(W T) and (F + U W^2) sin(W T)
    push               change of Z1'' by friction (`templates.friction`)
    r1, mobility       in contact: stiffness of the walls, and 1 + 1/rm
    draw, base_cosine, base_sine     if `across` is true: see `templates.across`
    h{k}, d{k}, e{k}   set by the lines that `constants(k)` returns. h{k} is DAMPING/max(k, 1), d{k}
                       is DASHPOT/max(k, 1). Coefficient k of the forcing is e{k} `cosine` if k is
                       even, and e{k} `sine` if k is odd.
    """
    for k in range(order - 1):
        yield from constants(k)
        if k > 0 and k % 2 == 0:
            yield from _lower_squares(k // 2)
        drive = f"e{k} * {'sine' if k % 2 else 'cosine'}"
        if k > 1:
            yield from _without_damping(k, drive)
        else:
            push = "" if k else " + push"
            yield f"c{k} = {drive}{push} - {'linear' if k else 'stiffness'} * x{k}"
        if across:
            moved = "base_sine" if k % 2 else "base_cosine"
            yield f"m{k} = c{k} - e{k} * {moved}" + (" + draw" if k == 0 else "")
        yield from _accelerations(k, phase, "m" if across else "c")


def tangent(order, phase, constants):
    """Yield lines of code that compute the Taylor series of a tangent up to `order`.

    A tangent is a solution of the variational equations. The variables x0, x1, ... are coefficients
    of the tangent's Z1, and q0, q1, ... of its depth. The lines read u0, u1, ..., which the lines
    of `squares` compute. The arguments mean what they mean in `motion`.
    """
    for k in range(order - 1):
        yield from constants(k)
        # Products of factors that are computed early come first in the sum.
        terms = [f"u{j} * x{k - j}" for j in sorted(range(1, k), key=lambda j: (max(j, k - j), j))]
        terms += [f"u{k} * x0"] if k > 0 else []
        yield f"c{k} = -{' - '.join([*terms, f'linear * x{k}'])}"
        yield from _accelerations(k, phase, "c")


def squares(count):
    """Yield lines of code that compute u0, u1, ..., the first `count` coefficients of 3 k3 x^2.

    3 k3 x^2 is the slope of the spring's nonlinear force at Z1 = x. The lines read the variable
    `cubic`, which holds k3, and the Taylor coefficients x0, x1, ... of Z1.
    """
    yield "triple = 3.0 * cubic"
    yield "sextuple = 6.0 * cubic"
    for k in range(count):
        terms = [f"x{j} * x{k - j}" for j in range((k + 1) // 2)]
        middle = [f"triple * x{k // 2} * x{k // 2}"] if k % 2 == 0 else []
        doubled = [f"sextuple * ({' + '.join(terms)})"] if terms else []
        yield f"u{k} = {' + '.join([*middle, *doubled])}"


def _lower_squares(n):
    # After these lines of code s0, ..., s{2n} are the coefficients of k3 (x0 + x1 t + ... + x{n}
    # t^n)^2. The lines add 2 k3 x{n} x{j} to s{n+j} for each j < n, and set s{2n} = k3 x{n}^2.
    yield f"y{n} = double * x{n}"
    for j in range(n - n % 2, 2 * n, 2):
        before = f"P{j}" if j < 2 * n - 2 else f"(s{j}, 0.0)"
        first = f"x{j - n}" if j >= n else "0.0"
        yield f"P{j} = {before} + y{n} * ({first}, x{j + 1 - n})"
        yield f"(s{j}, s{j + 1}) = P{j}"
    yield f"s{2 * n} = cubic * x{n} * x{n}"


def _without_damping(k, drive):
    # The lines set c{k} = f - s. f is coefficient k of the forcing, and `drive` is its code. s is
    # coefficient k of the spring's force.
    n, odd = k // 2, k % 2
    last = k - n - 1
    if odd and last % 2 and last > 1:
        yield f"Z{last - 1} = 3.0 * P{last - 1}"
    elif odd:
        yield f"z{last} = 3.0 * s{last}"
    single, pairs = [f"s{2 * n} * x{odd}"], []
    for j in range(odd + 1, n, 2):
        pairs.append(f"P{k - j - 1} * (x{j + 1}, x{j})")
    if (n - odd) % 2:
        single.append(f"s{last + 1} * x{n}")
    if last > 0 and last % 2 == 0:
        single.append(f"z{last} * x{k - last}")
    for m in range((last - 1) // 2 * 2, 1, -2):
        pairs.append(f"Z{m} * (x{k - m}, x{k - m - 1})")
    newest = [f"z1 * x{k - 1}"] if last > 0 else []
    early = " - ".join([drive, *single])
    if pairs:
        yield f"(first, second) = {' + '.join(pairs)}"
        early, newest = f"{early} - first", [f"({' + '.join(['second', *newest])})"]
    yield f"c{k} = {' - '.join([early, *newest])} - linear * x{k}"


def _accelerations(k, phase, loose):
    # The lines compute x{k+2}, and in contact also q{k+2}. x{k} is coefficient k of Z1, q{k} of the
    # depth in the wall, and c{k} of the acceleration by the forcing and the spring. m{k} is c{k}
    # plus coefficient k of Z2'' - Z1'' without the wall's force. x{k+2} follows from c{k}. q{k+2}
    # follows from c{k} if `loose` is "c", and from m{k} if `loose` is "m".
    a, b = (f"a{k - 1}", f"b{k - 1}") if k > 0 else ("x1", "q1")
    factor = 1 / ((k + 1) * (k + 2))
    yield f"g{k} = c{k} - h{k} * {a}"
    if phase == "contact":
        yield f"f{k} = r1 * q{k} + d{k} * {b}"
        yield f"l{k} = {loose}{k} - h{k} * {a}"
        yield f"b{k} = l{k} - mobility * f{k}"
        yield f"q{k + 2} = {factor!r} * b{k}"
    yield f"a{k} = g{k} - f{k}" if phase == "contact" else f"a{k} = g{k}"
    yield f"x{k + 2} = {factor!r} * a{k}"
