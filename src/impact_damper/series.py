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

These are written as lines of arithmetic in a loop over lanes, which are trajectories side by
side; `straight` compiles them. With one lane that gives scalar code, about three times as fast as
loops over arrays; with several, vector instructions, three times as fast again. All numbers of a
step stand in one flat array, `lanes` to a row; `rows` says in which row.
"""

from functools import partial

# What a step is given, what it finds, and what it needs on its way. Then the series: of Z1 and
# its rate, of the penetration and its rate, of g, of Z1^2, and of cos W t, whose terms still lack
# the cosine or sine of the phase. Those of a tangent, in an array of their own, are of the first
# four.
PARAMETERS = "FREQUENCY DAMPING STIFFNESS CLEARANCE CONTACT INVERSE_MASS DASHPOT".split()
STATE = "Y0 Y1 Y2 Y3".split()
STEP = "SIDE TIME LONGEST TOLERANCE LENGTH".split()
SCRATCH = (
    "COSINE SINE KNOWN TURNS ANGLE T Z1 Z1_SLOPE Z1_CURVE Z1_JERK "
    "DEPTH DEPTH_SLOPE DEPTH_CURVE DEPTH_JERK BOUND CHANGE TAIL FINE SCALE WALL MODE LOW HIGH "
    "NATURAL END_Z1 END_Z1_SLOPE END_DEPTH END_DEPTH_SLOPE"
).split()
SINGLE = PARAMETERS + STATE + STEP + SCRATCH
SERIES = "X V Q W G S E".split()
TANGENT_SERIES = "DX DV DQ DW".split()
# Most sums that are made at once.
SUMS = 6


def rows(flight_order, contact_order):
    """Numbers of the rows by name; `ROWS` and `TANGENT_ROWS` are how many there are.

    From `PARTS` on stand the parts of sums.
    """
    length = max(flight_order, contact_order) + 1
    single = {name: number for number, name in enumerate(SINGLE)}
    series = {name: len(SINGLE) + length * j for j, name in enumerate(SERIES)}
    tangent = {name: len(STATE) + length * j for j, name in enumerate(TANGENT_SERIES)}
    ends = {
        "PARTS": len(SINGLE) + length * len(SERIES),
        "ROWS": len(SINGLE) + length * len(SERIES) + 4 * SUMS,
        "TANGENT_ROWS": len(STATE) + length * len(TANGENT_SERIES),
    }
    return single | series | tangent | ends


class Writer:
    """Writes the series for a number of lanes and the orders of the two phases.

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

    def function(self, name, lines, tangent=False, first=(), side_by_side=4):
        """A kernel that does lines for each lane, and before them others, side by side."""
        arguments, lanes = ("a, d", self.tangents) if tangent else ("a", self.lanes)
        text, calls = "", ""
        for part, count, body in (("first", side_by_side, first), ("lines", lanes, lines)):
            if body:
                text += f"@straight\ndef {name}_{part}({arguments}):\n"
                text += f"    for i in range({count}):\n"
                text += "".join(f"        {line}\n" for line in body) + "\n\n"
                calls += f"    {name}_{part}({arguments})\n"
        return f"{text}@within\ndef {name}({arguments}):\n{calls}"

    def filled(self, phase):
        """The series that a step fills, and their orders."""
        order = self.orders[phase]
        orders = {"X": order, "V": order - 1, "G": order - 2, "S": order - 2}
        return orders | ({"Q": order, "W": order - 1} if phase == "contact" else {})

    def filled_of_tangent(self, phase):
        """The same of a tangent, in the order of its rows 0 to 3."""
        filled = self.filled(phase).items()
        return {name: last for name, last in filled if f"D{name}" in TANGENT_SERIES}

    def drive(self):
        """Fill the series of the drive, which stays the same while a trajectory does."""
        count = max(self.orders.values()) - 1
        places = {"E": partial(self.at, "E")}
        return self.function("drive_series", _stored(self._drive(count), places))

    def _drive(self, count):
        """Terms of the drive."""
        yield f"w = {self.at('FREQUENCY')}"
        yield "ww = w * w"
        yield "e0 = 1.0"
        yield "e1 = -w"
        for k in range(2, count):
            yield f"e{k} = {-1.0 / (k * (k - 1))!r} * ww * e{k - 2}"

    def series(self, phase):
        """Fill the series of a step: all of them in contact; X, V, G and S in flight.

        In several lanes there are other trajectories in each step, so the drive's is made here.
        """
        count = self.orders[phase] - 1
        kept = (f"e{k} = {self.at('E', k)}" for k in range(count))
        drive = kept if self.lanes == 1 else self._drive(count)
        lines = [
            f"cosine = {self.at('COSINE')}",
            f"sine = {self.at('SINE')}",
            *drive,
            f"x0 = {self.at('Y0')}",
            f"v0 = {self.at('Y1')}",
            "twice = 2.0 * x0",
            "s0 = x0 * x0",
            f"stiffness = {self.at('STIFFNESS')} + s0",
            "linear = stiffness + 2.0 * s0",
            *self._factors(phase),
        ]
        if phase == "contact":
            lines += [
                f"q0 = {self.at('Y2')} - {self.at('SIDE')} * {self.at('CLEARANCE')}",
                f"w0 = {self.at('Y3')}",
            ]
        lines += _recurrence(self.orders[phase], phase, tangent=False)
        places = {name: partial(self.at, name) for name in self.filled(phase)}
        return self.function(f"{phase}_series", _stored(lines, places))

    def tangent_series(self, phase):
        """Fill the series of a tangent over a step."""
        order = self.orders[phase]
        filled = self.filled_of_tangent(phase)
        lines = [
            *(f"s{k} = 3.0 * {self.at('S', k)}" for k in range(order - 1)),
            f"linear = {self.at('STIFFNESS')} + s0",
            *self._factors(phase),
            *(f"{name.lower()}0 = {self.at_tangent('', j)}" for j, name in enumerate(filled)),
            *_recurrence(order, phase, tangent=True),
        ]
        places = {name: partial(self.at_tangent, f"D{name}") for name in filled}
        return self.function(f"{phase}_tangent_series", _stored(lines, places), tangent=True)

    def _factors(self, phase):
        """Factors of the recurrence."""
        lines = [f"h = {self.at('DAMPING')}"]
        if phase == "contact":
            lines += [
                f"r1 = {self.at('CONTACT')}",
                f"dash = {self.at('DASHPOT')}",
                f"both = 1.0 + {self.at('INVERSE_MASS')}",
            ]
        return lines


def _stored(lines, places):
    """Lines, each followed by the store of what it gives, so that no number waits for it."""
    for line in lines:
        yield line
        given = line.split(" = ")[0]
        name, order = given[0].upper(), given[1:]
        if name in places and order.isdigit():
            yield f"{places[name](int(order))} = {given}"


def _recurrence(order, phase, tangent):
    """All orders, from x0 and v0 and in contact q0 and w0 on."""
    yield "x1 = v0"
    if phase == "contact":
        yield "q1 = w0"
    for k in range(order - 1):
        yield from _order(k, phase, tangent)


def _order(k, phase, tangent):
    """The lines that give v[k+1] and x[k+2], and in contact w[k+1] and q[k+2].

    Sums end with the terms that wait longest for their factors, and of v and w the terms before
    their division are waited for. Of s[k] the part p[k] with x[k] left out comes first; x[k] is
    then multiplied once, by `linear` = omega_l^2 + 3 x[0]^2.
    """
    last = f"s{k} * x0"
    if not tangent and k > 0:
        known = _square_but_ends(k)
        if known:
            yield f"p{k} = {known}"
        yield f"s{k} = p{k} + twice * x{k}" if known else f"s{k} = twice * x{k}"
        last = f"p{k} * x0" if known else ""
    terms = [f"s{j} * x{k - j}" for j in sorted(range(1, k), key=lambda j: (max(j, k - j), j))]
    terms += [last] if k > 0 and last else []
    terms += [f"linear * x{k}" if k > 0 or tangent else "stiffness * x0"]
    drive = "" if tangent else f"e{k} * {'sine' if k % 2 else 'cosine'}"
    known = f"{drive} - {' - '.join(terms)}"
    if phase == "flight":
        yield f"g{k} = {known} - h * v{k}"
        yield f"v{k + 1} = {1 / (k + 1)!r} * g{k}"
        yield f"x{k + 2} = {1 / (k + 1) / (k + 2)!r} * g{k}"
        return
    damping, dashpot = f"h * v{k}", f"dash * w{k}"
    if k > 0:
        damping, dashpot = f"{1 / k!r} * h * a{k - 1}", f"{1 / k!r} * dash * b{k - 1}"
    yield f"g{k} = {known} - {damping}"
    yield f"f{k} = r1 * q{k} + {dashpot}"
    for acceleration, rate, place, mobility in (("b", "w", "q", "both * "), ("a", "v", "x", "")):
        yield f"{acceleration}{k} = g{k} - {mobility}f{k}"
        yield f"{rate}{k + 1} = {1 / (k + 1)!r} * {acceleration}{k}"
        yield f"{place}{k + 2} = {1 / (k + 1) / (k + 2)!r} * {acceleration}{k}"


def _square_but_ends(k):
    """Coefficient k of x^2 without 2 x[0] x[k], each product taken once; or nothing."""
    terms = [f"x{j} * x{k - j}" for j in reversed(range(1, (k + 1) // 2))]
    middle = f"x{k // 2} * x{k // 2}" if k % 2 == 0 else ""
    doubled = f"2.0 * ({' + '.join(terms)})" if terms else ""
    return " + ".join(part for part in (middle, doubled) if part)
