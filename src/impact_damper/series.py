"""Taylor series of the motion, unrolled from one description of the recurrence.

Between events the motion is analytic, and the coefficients of its Taylor series
follow from those before them. With s = x^2 and the drive e = cos(W T),

    g[k] = e[k] - omega_l^2 x[k] - (s x)[k] - h v[k]
    v[k+1] = (g[k] - r1 q[k] - D w[k]) / (k+1)                    x[k+1] = v[k] / (k+1)
    w[k+1] = (g[k] - (1 + 1/rm) (r1 q[k] + D w[k])) / (k+1)       q[k+1] = w[k] / (k+1)

for Z1 = x and the signed penetration q = Z2 -+ d0 during contact, equations (3), (4)
and (20) to (24); g is what of the acceleration does not come from the wall. In flight there
is no q, and Z2 differs from x by its offset and drift only. The variational equations are
the same with e = 0 and 3 (s dx)[k] for the cube.

`source` writes these as straight-line Python on scalars in a loop over lanes, which are
trajectories side by side. With one lane it compiles to scalar code, about three times as
fast as loops over arrays; with several to vector instructions, three times as fast again.
All numbers of a step stand in one flat array, `lanes` to a row; `rows` says in which row.
"""

# What a step is given, what it finds, and what it needs on its way. Then the series: of Z1 and
# its rate, of the penetration and its rate, of g and of Z1^2. Those of a tangent, in an array of
# their own, are of the first four.
PARAMETERS = "FREQUENCY DAMPING STIFFNESS CLEARANCE CONTACT INVERSE_MASS DASHPOT".split()
STATE = "Y0 Y1 Y2 Y3".split()
STEP = "SIDE TIME LONGEST TOLERANCE LENGTH".split()
SCRATCH = (
    "COSINE SINE T VALUE SLOPE CURVE BOUND FINE SCALE WALL MODE LOW HIGH NATURAL "
    "END_VALUE END_SLOPE"
).split()
SINGLE = PARAMETERS + STATE + STEP + SCRATCH
SERIES = "X V Q W G S".split()
TANGENT_SERIES = "DX DV DQ DW".split()


def rows(flight_order, contact_order):
    """Numbers of the rows by name; `ROWS` and `TANGENT_ROWS` are how many there are."""
    length = max(flight_order, contact_order) + 1
    single = {name: number for number, name in enumerate(SINGLE)}
    series = {name: len(SINGLE) + length * j for j, name in enumerate(SERIES)}
    tangent = {name: len(STATE) + length * j for j, name in enumerate(TANGENT_SERIES)}
    ends = {
        "ROWS": len(SINGLE) + length * len(SERIES),
        "TANGENT_ROWS": len(STATE) + length * len(TANGENT_SERIES),
    }
    return single | series | tangent | ends


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
        """Fill the series of a step: all of them in contact; X, V, G and S in flight."""
        lines = [
            f"ww = {self.at('FREQUENCY')} * {self.at('FREQUENCY')}",
            f"e0 = {self.at('COSINE')}",
            f"e1 = -{self.at('FREQUENCY')} * {self.at('SINE')}",
            f"x0 = {self.at('Y0')}",
            f"v0 = {self.at('Y1')}",
            "twice = 2.0 * x0",
            "s0 = x0 * x0",
            f"stiffness = {self.at('STIFFNESS')} + s0",
            "linear = stiffness + 2.0 * s0",
            *self._given(phase),
        ]
        if phase == "contact":
            lines += [
                f"q0 = {self.at('Y2')} - {self.at('SIDE')} * {self.at('CLEARANCE')}",
                f"w0 = {self.at('Y3')}",
            ]
        lines += self._recurrence(phase, tangent=False)
        for name, last in self._written(phase).items():
            lines += [f"{self.at(name, k)} = {name.lower()}{k}" for k in range(last + 1)]
        return self.function(f"{phase}_series", lines)

    def tangent_series(self, phase):
        """Fill the series of a tangent over a step."""
        order = self.orders[phase]
        lines = [
            *(f"s{k} = 3.0 * {self.at('S', k)}" for k in range(order - 1)),
            f"linear = {self.at('STIFFNESS')} + s0",
            *self._given(phase),
        ]
        written = self._written_of_tangent(phase)
        lines += [f"{name.lower()}0 = {self.at_tangent('', j)}" for j, name in enumerate(written)]
        lines += self._recurrence(phase, tangent=True)
        for name, last in written.items():
            lines += [
                f"{self.at_tangent(f'D{name}', k)} = {name.lower()}{k}" for k in range(last + 1)
            ]
        return self.function(f"{phase}_tangent_series", lines, tangent=True)

    def _recurrence(self, phase, tangent):
        """All orders, from x0 and v0 and in contact q0 and w0 on."""
        yield "x1 = v0"
        if phase == "contact":
            yield "q1 = w0"
        for k in range(self.orders[phase] - 1):
            yield from _order(k, phase, tangent)

    def _given(self, phase):
        """Factors of the recurrence."""
        lines = [f"h = {self.at('DAMPING')}"]
        if phase == "contact":
            lines += [
                f"r1 = {self.at('CONTACT')}",
                f"dash = {self.at('DASHPOT')}",
                f"both = 1.0 + {self.at('INVERSE_MASS')}",
            ]
        return lines

    def _written(self, phase):
        """The series that a step fills, and their orders."""
        order = self.orders[phase]
        orders = {"X": order, "V": order - 1, "G": order - 2, "S": order - 2}
        return orders | ({"Q": order, "W": order - 1} if phase == "contact" else {})

    def _written_of_tangent(self, phase):
        """The same of a tangent, in the order of its rows 0 to 3."""
        return {
            name: last
            for name, last in self._written(phase).items()
            if f"D{name}" in TANGENT_SERIES
        }

    def values(self, phase, name, results, then=()):
        """Sums of series at T, and what follows; `results` gives each sum's row, and its series."""
        lines = [f"t = {self.at('T')}", *_powers()]
        orders = self._written(phase)
        for result, row in results.items():
            coefficients = [self.at(row, k) for k in range(orders[row] + 1)]
            lines += _sum(coefficients, self.at(result))
        return self.function(f"{phase}_{name}", [*lines, *then])

    def tangent_value(self, phase):
        """The tangent at T."""
        lines = [f"t = {self.at('T')}", *_powers()]
        for place, (name, last) in enumerate(self._written_of_tangent(phase).items()):
            coefficients = [self.at_tangent(f"D{name}", k) for k in range(last + 1)]
            lines += _sum(coefficients, self.at_tangent("", place))
        return self.function(f"{phase}_tangent_value", lines, tangent=True)

    def bound(self, phase):
        """BOUND on |g| over the LENGTH of the step, which in flight is a bound on |Z1''|."""
        order = self.orders[phase]
        lines = [f"t = {self.at('LENGTH')}", *_powers()]
        lines += _sum([f"abs({self.at('G', k)})" for k in range(order - 1)], self.at("BOUND"))
        return self.function(f"{phase}_bound", lines)

    def source(self):
        """The module."""
        x = {"VALUE": "X", "SLOPE": "V"}
        # Of the acceleration of the penetration, G is what does not come from the wall.
        q = {"VALUE": "Q", "SLOPE": "W", "CURVE": "G"}
        force = (
            f"{self.at('CONTACT')} * {self.at('VALUE')} + {self.at('DASHPOT')} * {self.at('SLOPE')}"
        )
        wall = f"{self.at('CURVE')} -= (1.0 + {self.at('INVERSE_MASS')}) * ({force})"
        functions = [
            *(self.series(phase) for phase in self.orders),
            *(self.tangent_series(phase) for phase in self.orders),
            *(self.tangent_value(phase) for phase in self.orders),
            *(self.bound(phase) for phase in self.orders),
            self.values("flight", "slope_x", x),
            self.values("flight", "curve_x", x | {"CURVE": "G"}),
            self.values("contact", "slope_x", x),
            self.values("contact", "curve_q", q, [wall]),
        ]
        return "from impact_damper.accelerate import kernel\n\n\n" + "\n\n".join(functions)


def _order(k, phase, tangent):
    """The lines that give v[k+1] and x[k+2], and in contact w[k+1] and q[k+2].

    Sums end with the terms that wait longest for their factors. Of s[k] the part p[k] with x[k]
    left out comes first; x[k] is then multiplied once, by `linear` = omega_l^2 + 3 x[0]^2.
    """
    last = f"s{k} * x0"
    if not tangent and k > 0:
        known = _square_but_ends(k)
        if known:
            yield f"p{k} = {known}"
        yield f"s{k} = p{k} + twice * x{k}" if known else f"s{k} = twice * x{k}"
        last = f"p{k} * x0" if known else ""
    if not tangent and k > 1:
        yield f"e{k} = {-1.0 / (k * (k - 1))!r} * ww * e{k - 2}"
    terms = [f"s{j} * x{k - j}" for j in sorted(range(1, k), key=lambda j: max(j, k - j))]
    terms += [last] if k > 0 and last else []
    terms += [f"linear * x{k}" if k > 0 or tangent else "stiffness * x0", f"h * v{k}"]
    yield f"g{k} = {'' if tangent else f'e{k}'} - {' - '.join(terms)}"
    force = ""
    if phase == "contact":
        force = f" - f{k}"
        yield f"f{k} = dash * w{k} + r1 * q{k}"
        yield f"w{k + 1} = {1 / (k + 1)!r} * (g{k} - both * f{k})"
        yield f"q{k + 2} = {1 / (k + 2)!r} * w{k + 1}"
    yield f"v{k + 1} = {1 / (k + 1)!r} * (g{k}{force})"
    yield f"x{k + 2} = {1 / (k + 2)!r} * v{k + 1}"


def _square_but_ends(k):
    """Coefficient k of x^2 without 2 x[0] x[k], each product taken once; or nothing."""
    terms = [f"x{j} * x{k - j}" for j in reversed(range(1, (k + 1) // 2))]
    middle = f"x{k // 2} * x{k // 2}" if k % 2 == 0 else ""
    doubled = f"2.0 * ({' + '.join(terms)})" if terms else ""
    return " + ".join(part for part in (middle, doubled) if part)


def _powers():
    """Powers of t for `_sum`."""
    yield "t2 = t * t"
    yield "t4 = t2 * t2"


def _sum(c, result):
    """Lines that add up a series at t: every fourth power apart, side by side, then together."""
    for j in range(4):
        part = c[j::4]
        yield f"part{j} = {part[-1]}"
        for term in part[-2::-1]:
            yield f"part{j} = part{j} * t4 + {term}"
    yield f"{result} = (part0 + t * part1) + t2 * (part2 + t * part3)"
