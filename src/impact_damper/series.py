"""Taylor series of the motion, unrolled from one description of the recurrence.

Between events the motion is analytic, and the coefficients of its Taylor series
follow from those before them. With s = x^2 and the drive e = cos(W T),

    x[k+2] = (e[k] - h (k+1) x[k+1] - omega_l^2 x[k] - (s x)[k] - f[k]) / ((k+1)(k+2))
    q[k+2] = x[k+2] - f[k] / (rm (k+1)(k+2))
    f[k]   = r1 q[k] + D (k+1) q[k+1]

for Z1 = x and the signed penetration q = Z2 -+ d0 during contact, equations (3), (4)
and (20) to (24); in flight f = 0 and q differs from x in its first two terms only.
The variational equations are the same with e = 0 and 3 (s dx)[k] for the cube.

`unrolled` writes these as straight-line Python on scalars, which compiles to code
about three times as fast as loops over arrays; the module it makes is kept beside
the compiled kernels.
"""

import importlib.util
import os
import sys
from itertools import chain

from impact_damper.accelerate import CACHE_DIRECTORY

FLIGHT_ORDER = 18
CONTACT_ORDER = 22
LENGTH = CONTACT_ORDER + 1


def _sum(terms):
    """A sum as two interleaved chains, which a processor can add side by side."""
    if len(terms) < 4:
        return " + ".join(terms)
    return f"({' + '.join(terms[::2])}) + ({' + '.join(terms[1::2])})"


def _square(k):
    """Coefficient k of x^2, each product of two different factors taken once."""
    pairs = _sum([f"x{j} * x{k - j}" for j in range((k + 1) // 2)])
    middle = f"x{k // 2} * x{k // 2}" if k % 2 == 0 else ""
    doubled = f"2.0 * ({pairs})" if pairs else ""
    return " + ".join(part for part in (doubled, middle) if part)


def _order(k, contact, tangent):
    """The lines that give x[k+2], and in contact q[k+2], from what came before."""
    scale = 1.0 / ((k + 1) * (k + 2))
    if not tangent:
        yield f"s{k} = {_square(k)}"
        if k > 1:
            yield f"e{k} = {-1.0 / (k * (k - 1))!r} * ww * e{k - 2}"
    cube = _sum([f"s{j} * x{k - j}" for j in range(k + 1)])
    terms = [f"3.0 * ({cube})" if tangent else cube, f"{k + 1}.0 * h * x{k + 1}", f"wl * x{k}"]
    if contact:
        yield f"f{k} = r1 * q{k} + {k + 1}.0 * dash * q{k + 1}"
        terms.append(f"f{k}")
    drive = "" if tangent else f"e{k} "
    yield f"x{k + 2} = {scale!r} * ({drive}- ({' + '.join(terms)}))"
    if contact:
        yield f"q{k + 2} = x{k + 2} - {scale!r} * im * f{k}"


def unrolled(name, contact, tangent):
    """Source of one function that fills coefficient arrays.

    The function takes the packed parameters, then cosine and sine of the forcing
    phase (state) or the coefficients of x^2 (tangent), then the first two
    coefficients of x (and of q in contact), then the arrays to fill.
    """
    order = CONTACT_ORDER if contact else FLIGHT_ORDER
    start = "x0, x1, q0, q1" if contact else "x0, x1"
    given = "square" if tangent else "cosine, sine"
    filled = "x, q" if contact else "x"
    lines = ["h = p[1]", "wl = p[2]"]
    if contact:
        lines += ["r1 = p[4]", "im = p[5]", "dash = p[6]"]
    if tangent:
        lines += [f"s{k} = square[{k}]" for k in range(order - 1)]
    else:
        lines += ["ww = p[0] * p[0]", "e0 = cosine", "e1 = -p[0] * sine"]
        filled += ", square"
    lines += chain.from_iterable(_order(k, contact, tangent) for k in range(order - 1))
    lines += [f"x[{k}] = x{k}" for k in range(order + 1)]
    if contact:
        lines += [f"q[{k}] = q{k}" for k in range(order + 1)]
    if not tangent:
        lines += [f"square[{k}] = s{k}" for k in range(order - 1)]
    body = "\n".join(f"    {line}" for line in lines if line)
    return f"@kernel\ndef {name}(p, {given}, {start}, {filled}):\n{body}\n"


def _module():
    """Write the unrolled functions to a module beside the compiled kernels, and import it."""
    name = "impact_damper_series"
    path = CACHE_DIRECTORY / f"{name}.py"
    if not path.exists():
        source = "from impact_damper.accelerate import kernel\n\n\n" + "\n\n".join(
            [
                unrolled("flight", contact=False, tangent=False),
                unrolled("contact", contact=True, tangent=False),
                unrolled("flight_tangent", contact=False, tangent=True),
                unrolled("contact_tangent", contact=True, tangent=True),
            ]
        )
        part = path.with_name(f"{path.name}.part-{os.getpid()}")
        part.write_text(source)
        os.replace(part, path)
    specification = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module


_SERIES = _module()
flight = _SERIES.flight
contact = _SERIES.contact
flight_tangent = _SERIES.flight_tangent
contact_tangent = _SERIES.contact_tangent
