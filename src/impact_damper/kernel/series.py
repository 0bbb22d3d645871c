"""Generate the source of kernels that compute the Taylor series of a step.

A kernel is a loop over lanes around the lines that `recurrence` yields. Each lane holds one of the
trajectories that are stepped side by side. The decorator `straight_lines.straight` compiles the
kernels. With one lane the code works on single numbers and pairs of numbers, and is about three
times as fast as loops over arrays. With several lanes the code consists of vector instructions and
is three times as fast again. All numbers of a step stand in one flat array. It consists of rows
with one number for each lane; the function `rows` returns the number of each row.

Z1 is the displacement of the primary mass, and Z2 its displacement relative to the loose mass.
"""

from itertools import chain

from impact_damper.kernel import recurrence
from impact_damper.model import packed

# Rows of a step, in this order:
# packed.NAMES    the packed parameters
# STATE           the state Z1, Z1', Z2, Z2' at the beginning of the step, afterwards at its end
# STEP            further arguments of the step, and its result LENGTH
# SCRATCH         intermediate results
# SERIES          coefficients of these series:
#                 X  Z1
#                 Q  penetration of the wall
#                 G  acceleration without the force of the wall
#                 U  slope of the spring's nonlinear force, for tangents
#                 and coefficients that are the same in all steps of a trajectory:
#                 E  forcing without its factor cosine or sine
#                 H  h/k, with the damping h
#                 D  D/k, with the dashpot coefficient D
# The array of a tangent has the tangent's STATE, and then the TANGENT_SERIES with the coefficients
# of its Z1 (DX) and of its penetration (DQ).
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
    """Return a dictionary from the name of each row to its number, for series of these orders.

    The dictionary has three further entries. PARTS is the number of the first row for partial sums.
    ROWS and TANGENT_ROWS are the numbers of rows of the two arrays.
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

    With one lane, the trajectory can have up to four tangents (solutions of the variational
    equations), which stand side by side. With several lanes each trajectory has one tangent.
    """

    def __init__(self, lanes, flight_order, contact_order):
        self.lanes = lanes
        self.tangents = lanes if lanes > 1 else 4
        self.orders = {"flight": flight_order, "contact": contact_order}
        self.rows = rows(flight_order, contact_order)

    def at(self, row, k=0):
        """Return the expression for a trajectory's entry in the k-th row after `row`."""
        index = (self.rows[row] + k) * self.lanes
        return f"a[{index} + i]" if self.lanes > 1 else f"a[{index}]"

    def at_tangent(self, row, k=0):
        """Return the expression for a tangent's entry in the k-th row after `row`.

        The row "" is the first one; rows 0 to 3 hold the tangent itself.
        """
        return f"d[{(self.rows.get(row, 0) + k) * self.tangents} + i]"

    def function(self, name, lines, tangent=False, first=(), side_by_side=4):
        """Return the source of a kernel that executes `lines` for each lane.

        The kernel first executes the lines `first`, on vectors of `side_by_side` numbers.
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
        """Return the names of the unknown series: X for Z1 and, in contact, Q for penetration."""
        return "XQ" if phase == "contact" else "X"

    def constant_series(self):
        """Return a kernel that fills the series which are the same in all steps of a trajectory."""
        lines = (self._computed(k, "EHD") for k in range(max(self.orders.values()) - 1))
        return self.function("constant_series", self._stored(chain.from_iterable(lines), "EHD"))

    def _computed(self, k, names):
        """Yield lines that compute coefficient k of the constant series with these names."""
        factor = f"{1 / k!r} * " if k > 1 else ""
        if "E" in names and k < 2:
            beginning = [f"w = {self.at('FREQUENCY')}", "e0 = 1.0"], ["ww = w * w", "e1 = -w"]
            yield from beginning[k]
        elif "E" in names:
            yield f"e{k} = {-1.0 / (k * (k - 1))!r} * ww * e{k - 2}"
        yield f"h{k} = {factor}{self.at('DAMPING')}"
        if "D" in names:
            yield f"d{k} = {factor}{self.at('DASHPOT')}"

    def _constants(self, phase, tangent):
        """Return a function of k that returns lines for coefficient k of the constant series.

        With one lane the lines read the coefficients from the array. With several lanes each step
        has other trajectories, so the lines compute the coefficients again.
        """
        names = ("" if tangent else "E") + ("HD" if phase == "contact" else "H")
        if self.lanes > 1:
            return lambda k: self._computed(k, names)
        return lambda k: [f"{name.lower()}{k} = {self.at(name, k)}" for name in names]

    def series(self, phase):
        """Return a kernel that fills the series of a step: X and G, and in contact Q."""
        lines = [
            f"cosine = {self.at('COSINE')}",
            f"sine = {self.at('SINE')}",
            f"x0 = {self.at('Y0')}",
            # Adding 0.0 keeps LLVM from loading x0 and x1 as one vector. The two were stored
            # separately, and the load of a vector would wait until both stores are complete.
            f"x1 = {self.at('Y1')} + 0.0",
            *recurrence.beginning(self.at),
            *self._factors(phase),
        ]
        if phase == "contact":
            lines += [
                f"q0 = {self.at('Y2')} - {self.at('SIDE')} * {self.at('CLEARANCE')}",
                f"q1 = {self.at('Y3')}",
            ]
        constants = self._constants(phase, tangent=False)
        lines += recurrence.motion(self.orders[phase], phase, constants)
        return self.function(f"{phase}_series", self._stored(lines, f"{self.moving(phase)}G"))

    def squares(self, phase):
        """Return a kernel that fills U, for the tangents, from the series of a step."""
        count = self.orders[phase] - 1
        lines = list(recurrence.coefficients(self.at))
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
            *recurrence.tangent(order, phase, self._constants(phase, tangent=True)),
        ]
        lines = self._stored(lines, names, tangent=True)
        return self.function(f"{phase}_tangent_series", lines, tangent=True)

    def _factors(self, phase):
        """Yield lines for the factors that the recurrence needs in contact."""
        if phase == "contact":
            yield f"r1 = {self.at('CONTACT_STIFFNESS')}"
            yield f"mobility = 1.0 + {self.at('INVERSE_MASS_RATIO')}"

    def _stored(self, lines, names, tangent=False):
        """Yield `lines`, each coefficient of `names` followed by a line that stores it.

        The stores are thereby spread over the computation.
        """
        for line in lines:
            yield line
            target = line.split(" = ")[0]
            name, order = target[0].upper(), target[1:]
            if name in names and order.isdigit():
                at = (
                    self.at_tangent(f"D{name}", int(order))
                    if tangent
                    else self.at(name, int(order))
                )
                yield f"{at} = {target}"
