"""Writes the source of kernels that compute the Taylor series of a step.

The kernels consist of the lines of `recurrence` in a loop over lanes, which are trajectories side
by side, and are compiled by `straight`. With one lane the code works on single numbers and pairs of
them, about three times as fast as loops over arrays. With several lanes it consists of vector
instructions, three times as fast again. All numbers of a step stand in one flat array of rows, each
with one number for every lane; `rows` gives the number of each row.
"""

from itertools import chain

from impact_damper.kernel import recurrence
from impact_damper.system import packed

# Rows of a step, in this order:
# packed.NAMES    the packed parameters
# STATE           the state Z1, Z1', Z2, Z2' at the beginning, and afterwards at the end
# STEP            what else the step is given (LENGTH is its result)
# SCRATCH         intermediate results
# SERIES          coefficients of Z1 (X), of the penetration (Q), of the acceleration that does not
#                 come from a wall (G), of 3 k3 Z1^2 for tangents (U); then the series that are the
#                 same in all steps of a trajectory: of cos W t, whose terms still lack the cosine
#                 or sine of the phase (E), and h and D over the orders (H, D)
# The array of a tangent has its STATE, then TANGENT_SERIES: the coefficients of its Z1 and Z2.
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
# Largest number of sums that one kernel computes.
SUMS = 6


def rows(flight_order, contact_order):
    """Return the number of each row by its name, for series of these orders.

    Beside the rows above, `PARTS` is the first row for partial sums, and `ROWS` and `TANGENT_ROWS`
    are the numbers of rows of the two arrays.
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
    """Writes the kernels of the series for a number of lanes and the orders in flight and contact.

    With one lane, up to four tangents of the trajectory stand side by side and share its series.
    With several lanes each trajectory has one tangent.
    """

    def __init__(self, lanes, flight_order, contact_order):
        self.lanes = lanes
        self.tangents = lanes if lanes > 1 else 4
        self.orders = {"flight": flight_order, "contact": contact_order}
        self.rows = rows(flight_order, contact_order)

    def at(self, row, k=0):
        """Return the expression for a number of the trajectory: a row, or the k-th after it."""
        index = (self.rows[row] + k) * self.lanes
        return f"a[{index} + i]" if self.lanes > 1 else f"a[{index}]"

    def at_tangent(self, row, k=0):
        """Return the expression for a number of a tangent; rows 0 to 3 are the tangent itself."""
        return f"d[{(self.rows.get(row, 0) + k) * self.tangents} + i]"

    def function(self, name, lines, tangent=False, first=(), side_by_side=4):
        """Return the source of a kernel that executes `lines` for each lane.

        Before these it executes the lines `first`, if any, for `side_by_side` elements of vectors.
        """
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
        """Return the names of the unknown series: Z1, and in contact also the penetration."""
        return "XQ" if phase == "contact" else "X"

    def kept_series(self):
        """Return a kernel that fills the series which are the same in all steps of a trajectory."""
        made = (self._made(k, "EHD") for k in range(max(self.orders.values()) - 1))
        return self.function("kept_series", self._stored(chain.from_iterable(made), "EHD"))

    def _made(self, k, names):
        """Yield lines that compute coefficient k of the kept series with these names."""
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
        """Return a function of k that gives lines for coefficient k of the kept series.

        With one lane they are read from the array. With several lanes each step has other
        trajectories, so the coefficients are computed anew.
        """
        names = ("" if tangent else "E") + ("HD" if phase == "contact" else "H")
        if self.lanes > 1:
            return lambda k: self._made(k, names)
        return lambda k: [f"{name.lower()}{k} = {self.at(name, k)}" for name in names]

    def series(self, phase):
        """Return a kernel that fills the series of a step: X and G, and in contact Q."""
        lines = [
            f"cosine = {self.at('COSINE')}",
            f"sine = {self.at('SINE')}",
            f"x0 = {self.at('Y0')}",
            # The sum keeps LLVM from loading x0 and x1 as one vector. They were stored separately,
            # and such a load must wait until both stores are complete.
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
        """Return a kernel that fills U, for the tangents, from the series of a step."""
        count = self.orders[phase] - 1
        lines = [f"cubic = {self.at('CUBIC')}"]
        lines += [f"x{k} = {self.at('X', k)}" for k in range(count)]
        lines += self._stored(recurrence.squares(count), "U")
        return self.function(f"{phase}_squares", lines)

    def tangent_series(self, phase):
        """Return a kernel that fills the series of a tangent over a step, from U."""
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
        """Yield lines for the factors that the recurrence needs in contact."""
        if phase == "contact":
            yield f"r1 = {self.at('CONTACT_STIFFNESS')}"
            yield f"mobility = 1.0 + {self.at('INVERSE_MASS_RATIO')}"

    def _stored(self, lines, names, tangent=False):
        """Yield lines, and after each that computes a coefficient of `names` the line to store it.

        So the stores are spread over the lines and do not follow all of them.
        """
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
