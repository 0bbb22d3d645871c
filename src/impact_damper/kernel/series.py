"""Taylor series of the motion, unrolled from one description of the recurrence.

The lines of `recurrence` stand in a loop over lanes, which are trajectories side by side;
`straight` compiles them. With one lane that gives code for single numbers and pairs of them, about
three times as fast as loops over arrays; with several, vector instructions, three times as fast
again. All numbers of a step stand in one flat array, `lanes` to a row; `rows` says in which row.
"""

from itertools import chain

from impact_damper.kernel import recurrence
from impact_damper.system import packed

# Rows of a step: the packed parameters, what else the step is given, what it finds, and what it
# needs on its way. Then the series: of Z1, of the penetration, of g and, for tangents, of
# 3 k3 Z1^2; and what stays the same while a trajectory does, the series of cos W t, whose terms
# still lack the cosine or sine of the phase, and h and D over the orders. Those of a tangent, in an
# array of their own, are of the first two.
STATE = "Y0 Y1 Y2 Y3".split()
STEP = "SIDE TIME LONGEST TOLERANCE LENGTH".split()
SCRATCH = (
    "COSINE SINE KNOWN TURNS ANGLE T Z1 Z1_SLOPE Z1_CURVE Z1_JERK "
    "DEPTH DEPTH_SLOPE DEPTH_CURVE DEPTH_JERK BOUND CHANGE TAIL FINE SCALE WALL MODE LOW HIGH "
    "NATURAL END_Z1 END_Z1_SLOPE END_DEPTH END_DEPTH_SLOPE"
).split()
SINGLE = list(packed.NAMES) + STATE + STEP + SCRATCH
SERIES = "X Q G U E H D".split()
TANGENT_SERIES = "DX DQ".split()
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
        return f"{text}@kernel_only\ndef {name}({arguments}):\n{calls}"

    def moving(self, phase):
        """The series of what moves in a phase: of Z1, and in contact of the penetration."""
        return "XQ" if phase == "contact" else "X"

    def kept_series(self):
        """Fill the series that stay the same while a trajectory does."""
        made = (self._made(k, "EHD") for k in range(max(self.orders.values()) - 1))
        return self.function("kept_series", self._stored(chain.from_iterable(made), "EHD"))

    def _made(self, k, names):
        """Lines for coefficients k of kept series."""
        share = f"{1 / k!r} * " if k > 1 else ""
        if "E" in names and k < 2:
            beginning = [f"w = {self.at('FREQUENCY')}", "e0 = 1.0"], ["ww = w * w", "e1 = -w"]
            yield from beginning[k]
        elif "E" in names:
            yield f"e{k} = {-1.0 / (k * (k - 1))!r} * ww * e{k - 2}"
        yield f"h{k} = {share}{self.at('DAMPING')}"
        if "D" in names:
            yield f"d{k} = {share}{self.at('DASHPOT')}"

    def _kept(self, phase, tangent):
        """What gives lines for coefficients of the kept series that a step needs.

        With one lane they are read off. In several lanes there are other trajectories in each
        step, so they are made.
        """
        names = ("" if tangent else "E") + ("HD" if phase == "contact" else "H")
        if self.lanes > 1:
            return lambda k: self._made(k, names)
        return lambda k: [f"{name.lower()}{k} = {self.at(name, k)}" for name in names]

    def series(self, phase):
        """Fill the series of a step: X and G, and in contact Q."""
        lines = [
            f"cosine = {self.at('COSINE')}",
            f"sine = {self.at('SINE')}",
            f"x0 = {self.at('Y0')}",
            # Not loaded together with x0: a pair of numbers stored one by one is waited for.
            f"x1 = {self.at('Y1')} + 0.0",
            f"cubic = {self.at('CUBIC')}",
            "double = 2.0 * cubic",
            "s0 = cubic * x0 * x0",
            f"stiffness = {self.at('STIFFNESS')} + s0",
            "linear = stiffness + 2.0 * s0",
            *self._factors(phase),
        ]
        if phase == "contact":
            lines += [
                f"q0 = {self.at('Y2')} - {self.at('SIDE')} * {self.at('CLEARANCE')}",
                f"q1 = {self.at('Y3')}",
            ]
        lines += recurrence.motion(self.orders[phase], phase, self._kept(phase, tangent=False))
        return self.function(f"{phase}_series", self._stored(lines, f"{self.moving(phase)}G"))

    def squares(self, phase):
        """Fill U from the series of a step, for its tangents."""
        count = self.orders[phase] - 1
        lines = [f"cubic = {self.at('CUBIC')}"]
        lines += [f"x{k} = {self.at('X', k)}" for k in range(count)]
        lines += self._stored(recurrence.squares(count), "U")
        return self.function(f"{phase}_squares", lines)

    def tangent_series(self, phase):
        """Fill the series of a tangent over a step, from U."""
        order, names = self.orders[phase], self.moving(phase)
        lines = [
            *(f"u{k} = {self.at('U', k)}" for k in range(order - 1)),
            f"linear = {self.at('STIFFNESS')} + u0",
            *self._factors(phase),
            *(
                f"{name.lower()}{k} = {self.at_tangent('', 2 * j + k)}"
                for j, name in enumerate(names)
                for k in range(2)
            ),
            *recurrence.tangent(order, phase, self._kept(phase, tangent=True)),
        ]
        lines = self._stored(lines, names, tangent=True)
        return self.function(f"{phase}_tangent_series", lines, tangent=True)

    def _factors(self, phase):
        """Factors of the recurrence in contact."""
        if phase == "contact":
            yield f"r1 = {self.at('CONTACT_STIFFNESS')}"
            yield f"mobility = 1.0 + {self.at('INVERSE_MASS_RATIO')}"

    def _stored(self, lines, names, tangent=False):
        """Lines, those for coefficients followed by their store, so that no number waits for it."""
        for line in lines:
            yield line
            given = line.split(" = ")[0]
            name, order = given[0].upper(), given[1:]
            if name in names and order.isdigit():
                at = (
                    self.at_tangent(f"D{name}", int(order))
                    if tangent
                    else self.at(name, int(order))
                )
                yield f"{at} = {given}"
