"""Taylor series of the motion, unrolled from one description of the recurrence.

Between events the motion is analytic, and the coefficients of its Taylor series
follow from those before them. With s = x^2 and the drive e = cos(W T),

    x[k+2] = (e[k] - h (k+1) x[k+1] - omega_l^2 x[k] - (s x)[k] - f[k]) / ((k+1)(k+2))
    q[k+2] = x[k+2] - f[k] / (rm (k+1)(k+2))
    f[k]   = r1 q[k] + D (k+1) q[k+1]

for Z1 = x and the signed penetration q = Z2 -+ d0 during contact, equations (3), (4)
and (20) to (24); in flight f = 0 and q differs from x in its first two terms only.
The variational equations are the same with e = 0 and 3 (s dx)[k] for the cube.

`source` writes these as straight-line Python on scalars in a loop over lanes, which are
trajectories side by side. With one lane it compiles to scalar code, about three times as
fast as loops over arrays; with several to vector instructions, three times as fast again.
All numbers of a step stand in one flat array, `lanes` to a row; `rows` says in which row.
"""

from itertools import chain

# What a step is given, what it finds, and what it needs on its way. X, Q and S below are
# the series of Z1, of the penetration and of Z1^2; D are those of a tangent, in an array
# of their own.
PARAMETERS = "FREQUENCY DAMPING STIFFNESS CLEARANCE CONTACT INVERSE_MASS DASHPOT".split()
STATE = "Y0 Y1 Y2 Y3".split()
STEP = "SIDE TIME LONGEST TOLERANCE LENGTH".split()
SCRATCH = (
    "COSINE SINE T VALUE SLOPE CURVE BOUND FINE SCALE WALL MODE LOW HIGH NATURAL "
    "END_VALUE END_SLOPE"
).split()
SINGLE = PARAMETERS + STATE + STEP + SCRATCH
SERIES = ["X", "Q", "S"]
DERIVATIVES = ["value", "slope", "curve"]


def rows(flight_order, contact_order):
    """Numbers of the rows by name; `ROWS` and `TANGENT_ROWS` are how many there are."""
    length = max(flight_order, contact_order) + 1
    count = len(SINGLE)
    return {name: number for number, name in enumerate(SINGLE)} | {
        "X": count,
        "Q": count + length,
        "S": count + 2 * length,
        "ROWS": count + 3 * length,
        "DX": 4,
        "DQ": 4 + length,
        "TANGENT_ROWS": 4 + 2 * length,
    }


class Writer:
    """Writes the functions for a number of lanes and the orders of the series.

    With one lane up to four tangents stand side by side and share its series; with several
    lanes each has one tangent.
    """

    def __init__(self, lanes, flight_order, contact_order):
        self.lanes = lanes
        self.tangents = lanes if lanes > 1 else 4
        self.orders = {"flight": flight_order, "contact": contact_order}
        self.rows = rows(flight_order, contact_order)

    def at(self, row, k=0):
        """A number of the trajectory."""
        place = (self.rows[row] + k) * self.lanes
        return f"a[{place} + i]" if self.lanes > 1 else f"a[{place}]"

    def at_tangent(self, row, k=0):
        """A number of a tangent; rows 0 to 3 are the tangent itself."""
        return f"d[{(self.rows.get(row, 0) + k) * self.tangents} + i]"

    def function(self, name, lines, tangent=False):
        """A function that does the lines for each lane."""
        arguments, lanes = ("a, d", self.tangents) if tangent else ("a", self.lanes)
        body = "\n".join(f"        {line}" for line in lines)
        return f"@kernel\ndef {name}({arguments}):\n    for i in range({lanes}):\n{body}\n"

    def series(self, phase):
        """Fill the series of a step: X and S, and Q in contact."""
        order = self.orders[phase]
        lines = [
            f"h = {self.at('DAMPING')}",
            f"wl = {self.at('STIFFNESS')}",
            f"ww = {self.at('FREQUENCY')} * {self.at('FREQUENCY')}",
            f"e0 = {self.at('COSINE')}",
            f"e1 = -{self.at('FREQUENCY')} * {self.at('SINE')}",
            f"x0 = {self.at('Y0')}",
            f"x1 = {self.at('Y1')}",
            "twice = 2.0 * x0",
        ]
        if phase == "contact":
            lines += self._contact_given()
            lines += [
                f"q0 = {self.at('Y2')} - {self.at('SIDE')} * {self.at('CLEARANCE')}",
                f"q1 = {self.at('Y3')}",
            ]
        lines += chain.from_iterable(_order(k, phase, tangent=False) for k in range(order - 1))
        lines += [f"{self.at('X', k)} = x{k}" for k in range(order + 1)]
        lines += [f"{self.at('S', k)} = s{k}" for k in range(order - 1)]
        if phase == "contact":
            lines += [f"{self.at('Q', k)} = q{k}" for k in range(order + 1)]
        return self.function(f"{phase}_series", lines)

    def tangent_series(self, phase):
        """Fill the series of a tangent over a step: DX, and DQ in contact."""
        order = self.orders[phase]
        lines = [
            f"h = {self.at('DAMPING')}",
            f"wl = {self.at('STIFFNESS')}",
            *(f"s{k} = {self.at('S', k)}" for k in range(order - 1)),
            f"x0 = {self.at_tangent('', 0)}",
            f"x1 = {self.at_tangent('', 1)}",
        ]
        if phase == "contact":
            lines += self._contact_given()
            lines += [f"q0 = {self.at_tangent('', 2)}", f"q1 = {self.at_tangent('', 3)}"]
        lines += chain.from_iterable(_order(k, phase, tangent=True) for k in range(order - 1))
        lines += [f"{self.at_tangent('DX', k)} = x{k}" for k in range(order + 1)]
        if phase == "contact":
            lines += [f"{self.at_tangent('DQ', k)} = q{k}" for k in range(order + 1)]
        return self.function(f"{phase}_tangent_series", lines, tangent=True)

    def _contact_given(self):
        return [
            f"r1 = {self.at('CONTACT')}",
            f"dash = {self.at('DASHPOT')}",
            f"c = 1.0 + {self.at('INVERSE_MASS')}",
        ]

    def value(self, phase, row, derivatives):
        """VALUE and SLOPE of the series of a row at T, and CURVE if two derivatives are wanted."""
        order = self.orders[phase]
        coefficients = [self.at(row, k) for k in range(order + 1)]
        lines = [f"t = {self.at('T')}", *_horner(coefficients, derivatives)]
        lines += [f"{self.at(name.upper())} = {name}" for name in DERIVATIVES[: derivatives + 1]]
        return self.function(f"{phase}_{DERIVATIVES[derivatives]}_{row.lower()}", lines)

    def tangent_value(self, phase):
        """The tangent at T."""
        lines = [f"t = {self.at('T')}"]
        order = self.orders[phase]
        for place, row in ((0, "DX"), (2, "DQ"))[: 2 if phase == "contact" else 1]:
            lines += _horner([self.at_tangent(row, k) for k in range(order + 1)], 1)
            lines += [f"{self.at_tangent('', place)} = value"]
            lines += [f"{self.at_tangent('', place + 1)} = slope"]
        return self.function(f"{phase}_tangent_value", lines, tangent=True)

    def bound(self, phase):
        """BOUND on |Z1''| in flight, on |Z1'' + f| in contact, over the LENGTH of the step.

        In contact f = rm (Z1'' - Q'') leaves of Z1'' what does not come from the wall.
        """
        lines = [f"t = {self.at('LENGTH')}"]
        if phase == "contact":
            lines += [f"m = 1.0 / {self.at('INVERSE_MASS')}"]
        terms = []
        for k in range(2, self.orders[phase] + 1):
            size = self.at("X", k)
            if phase == "contact":
                size = f"{size} + m * ({size} - {self.at('Q', k)})"
            terms.append(f"{float(k * (k - 1))} * abs({size})")
        lines += _horner(terms, 0)
        lines += [f"{self.at('BOUND')} = value"]
        return self.function(f"{phase}_bound", lines)

    def source(self):
        """The module."""
        functions = [
            *(self.series(phase) for phase in self.orders),
            *(self.tangent_series(phase) for phase in self.orders),
            *(self.tangent_value(phase) for phase in self.orders),
            *(self.bound(phase) for phase in self.orders),
            self.value("flight", "X", 1),
            self.value("flight", "X", 2),
            self.value("contact", "X", 1),
            self.value("contact", "Q", 2),
        ]
        return "from impact_damper.accelerate import kernel\n\n\n" + "\n\n".join(functions)


def _order(k, phase, tangent):
    """The lines that give x[k+2], and in contact q[k+2], from what came before.

    Sums end with the terms that wait longest for their factors: what is known is added up by
    then, and one multiplication and addition leads from x[k+1] to x[k+2].
    """
    scale = 1.0 / ((k + 1) * (k + 2))
    ratio = 1.0 / (k + 2)
    if not tangent:
        yield f"s{k} = {_square(k)}"
        if k > 1:
            yield f"e{k} = {-1.0 / (k * (k - 1))!r} * ww * e{k - 2}"
    known = f"{-scale!r} * wl * x{k}" if tangent else f"{scale!r} * (e{k} - wl * x{k})"
    known = f"({known} - {3 * scale if tangent else scale!r} * ({_cube(k)}))"
    damping = f"- ({ratio!r} * h) * x{k + 1}"
    if phase == "flight":
        yield f"x{k + 2} = {known} {damping}"
        return
    yield f"known = {known}"
    for name, mobility in (("x", ""), ("q", "c * ")):
        spring = f"- ({scale!r} * {mobility}r1) * q{k}"
        dashpot = f"- ({ratio!r} * {mobility}dash) * q{k + 1}"
        yield f"{name}{k + 2} = ((known {spring}) {damping}) {dashpot}"


def _square(k):
    """Coefficient k of x^2, each product of two different factors taken once."""
    if k == 0:
        return "x0 * x0"
    terms = [f"x{j} * x{k - j}" for j in reversed(range(1, (k + 1) // 2))]
    middle = f"x{k // 2} * x{k // 2}" if k % 2 == 0 else ""
    doubled = f"2.0 * ({' + '.join(terms)})" if terms else ""
    known = " + ".join(part for part in (middle, doubled) if part)
    return f"({known}) + twice * x{k}" if known else f"twice * x{k}"


def _cube(k):
    """Coefficient k of x^3."""
    if k == 0:
        return "s0 * x0"
    terms = sorted(range(1, k), key=lambda j: max(j, k - j))
    known = " + ".join(f"s{j} * x{k - j}" for j in terms)
    last = f"s0 * x{k}"
    return f"(({known}) + {last}) + s{k} * x0" if known else f"{last} + s{k} * x0"


def _horner(c, derivatives):
    """Lines that give `value`, `slope` and `curve` of a polynomial in t, by Horner's rule.

    Even and odd powers are taken apart, and added up side by side.
    """
    yield "u = t * t"
    for name, part in (("even", c[::2]), ("odd", c[1::2])):
        for level in range(derivatives + 1):
            yield f"{name}{level} = {part[-1] if level == 0 else '0.0'}"
        for term in part[-2::-1]:
            for level in range(derivatives, 0, -1):
                yield f"{name}{level} = {name}{level} * u + {name}{level - 1}"
            yield f"{name}0 = {name}0 * u + {term}"
    yield "value = even0 + t * odd0"
    if derivatives > 0:
        yield "slope = odd0 + 2.0 * (t * even1 + u * odd1)"
    if derivatives > 1:
        yield "curve = (2.0 * even1 + 6.0 * (t * odd1)) + 8.0 * u * (even2 + t * odd2)"
