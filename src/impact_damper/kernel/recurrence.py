"""The recurrence of the Taylor series, as lines of arithmetic.

Between events the motion is analytic, and the coefficients of its Taylor series
follow from those before them. With the forcing e = (F + U W^2) cos(W T), a = Z1'' and b = q'',

    g[k] = e[k] - omega_l^2 x[k] - k3 (x^3)[k] - h/k a[k-1]
    f[k] = r1 q[k] + D/k b[k-1]
    a[k] = g[k] - f[k]                   x[k+2] = a[k] / ((k+1) (k+2))
    b[k] = g[k] - (1 + 1/rm) f[k]        q[k+2] = b[k] / ((k+1) (k+2))

(for k = 0 with h x[1] and D q[1] at the ends) for Z1 = x and the signed penetration q = Z2 -+ d0
during contact, equations (3), (4) and (20) to (24); g is what of the acceleration does not come
from the wall. In flight there is no q, and Z2 differs from x by its offset and drift only. The
variational equations are the same with e = 0 and 3 k3 (x^2 dx)[k] for the cube.

In (x^3)[k] no product of three coefficients has two of them beyond the half of k. With l for x
up to there, n = k // 2,

    (x^3)[k] = (l^3)[k] + 3 sum over j > n of (x^2)[k-j] x[j].

Each of the newest coefficients so stands in one product, which comes last. The squares s of l,
times k3, grow with it. They stand in pairs of neighbours, P, as do those taken three times, Z, and
the products of the sums: with one trajectory, a pair is one register.
"""


def motion(order, phase, kept):
    """Lines for all orders of a step's series.

    They need x0, x1 and s0 = k3 x0^2, in contact q0 and q1, and the factors `cosine` and `sine`,
    which are those of the phase times the amplitude of the forcing, `cubic` = k3, `stiffness` =
    omega_l^2 + s0, `linear` = omega_l^2 + 3 s0, `r1` and `mobility` = 1 + 1/rm. `kept(k)` gives
    lines for h/k, D/k and e[k] but for its cosine or sine, which stay the same while a trajectory
    does.
    """
    for k in range(order - 1):
        yield from kept(k)
        if k > 0 and k % 2 == 0:
            yield from _lower_squares(k // 2)
        drive = f"e{k} * {'sine' if k % 2 else 'cosine'}"
        if k > 1:
            yield from _without_damping(k, drive)
        else:
            yield f"c{k} = {drive} - {'linear' if k else 'stiffness'} * x{k}"
        yield from _accelerations(k, phase)


def tangent(order, phase, kept):
    """The same of a tangent, x and q, from `u0`, `u1` and so on, the coefficients of 3 k3 Z1^2."""
    for k in range(order - 1):
        yield from kept(k)
        # Last what waits for the longest series of factors.
        terms = [f"u{j} * x{k - j}" for j in sorted(range(1, k), key=lambda j: (max(j, k - j), j))]
        terms += [f"u{k} * x0"] if k > 0 else []
        yield f"c{k} = -{' - '.join([*terms, f'linear * x{k}'])}"
        yield from _accelerations(k, phase)


def squares(count):
    """Lines for so many coefficients u of 3 k3 x^2, each product taken once; they need `cubic`."""
    yield "triple = 3.0 * cubic"
    yield "sextuple = 6.0 * cubic"
    for k in range(count):
        terms = [f"x{j} * x{k - j}" for j in range((k + 1) // 2)]
        middle = [f"triple * x{k // 2} * x{k // 2}"] if k % 2 == 0 else []
        doubled = [f"sextuple * ({' + '.join(terms)})"] if terms else []
        yield f"u{k} = {' + '.join([*middle, *doubled])}"


def _lower_squares(n):
    """Lines that take x[n] into the squares: s[2n], and before it pairs from s[n] or s[n-1] on."""
    yield f"y{n} = double * x{n}"
    for j in range(n - n % 2, 2 * n, 2):
        before = f"P{j}" if j < 2 * n - 2 else f"(s{j}, 0.0)"
        first = f"x{j - n}" if j >= n else "0.0"
        yield f"P{j} = {before} + y{n} * ({first}, x{j + 1 - n})"
        yield f"(s{j}, s{j + 1}) = P{j}"
    yield f"s{2 * n} = cubic * x{n} * x{n}"


def _without_damping(k, drive):
    """Lines for c[k], which is g[k] without h/k a[k-1]; k > 1."""
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


def _accelerations(k, phase):
    """Lines for g[k] and x[k+2], and in contact q[k+2]."""
    a, b = (f"a{k - 1}", f"b{k - 1}") if k > 0 else ("x1", "q1")
    share = 1 / ((k + 1) * (k + 2))
    yield f"g{k} = c{k} - h{k} * {a}"
    if phase == "contact":
        yield f"f{k} = r1 * q{k} + d{k} * {b}"
        yield f"b{k} = g{k} - mobility * f{k}"
        yield f"q{k + 2} = {share!r} * b{k}"
    yield f"a{k} = g{k} - f{k}" if phase == "contact" else f"a{k} = g{k}"
    yield f"x{k + 2} = {share!r} * a{k}"
