"""Generate Python modules that compute an integration step.

A module is made for a number of lanes, and for the orders of Taylor series in flight and in
contact. Each lane holds one trajectory. A module contains the templates, which `branches` compiles,
and kernels that compute Taylor series, which `straight_lines` compiles. All numbers of a step stand
in a flat array of rows. Each row has one number for each lane.
"""

import importlib.util
import inspect
import math
import os
import re
import sys
from itertools import chain

from impact_damper.kernel import branches, equation
from impact_damper.kernel.compiling import CACHE_DIRECTORY
from impact_damper.kernel.straight_lines import straight
from impact_damper.kernel.templates import (
    across,
    contact,
    forcing,
    friction,
    root_search,
    separation,
    step,
)
from impact_damper.model import packed
from impact_damper.model.parameters import NONLINEAR

# Orders of the Taylor series. With these orders the integration is fastest at medium tolerances.
FLIGHT_ORDER = 18
CONTACT_ORDER = 23
# Groups of rows in the array of a step, in this order:
# packed.NAMES    the packed parameters
# STATE           the state Z1, Z1', Z2, Z2' at the beginning of the step, afterwards at its end
# STEP            SIDE, TIME, LONGEST, TOLERANCE: arguments of the step; SIDE, LENGTH: results
# SCRATCH, FREE   intermediate results
# SERIES          Taylor coefficients, a row for each order k:
#   X  Z1                           Q  depth in a wall, Z2 - SIDE d0
#   G  Z1'' without wall's force    U  slope of the spring's nonlinear force
#   H  DAMPING/k                    D  DASHPOT/k
#   E  forcing, divided by COSINE if k is even, and by SINE if k is odd
# A tangent is a solution of the variational equations. Groups of a tangent's rows, in this order:
# STATE           the tangent's Z1, Z1', Z2, Z2'
# KEPT            the tangent's Z2 at the beginning of a step in which the loose mass sticks
# TANGENT_SERIES  coefficients of the tangent's Z1 (DX) and of the tangent's depth (DQ)
STATE = "Y0 Y1 Y2 Y3".split()
STEP = "SIDE TIME LONGEST TOLERANCE LENGTH".split()
SCRATCH = (
    "COSINE SINE KNOWN TURNS ANGLE CIRCLE_COSINE CIRCLE_SINE T Z1 Z1_SLOPE Z1_CURVE Z1_JERK "
    "DEPTH DEPTH_SLOPE DEPTH_CURVE DEPTH_JERK BOUND CHANGE SNAP TAIL FINE SCALE WALL MODE LOW HIGH "
    "NATURAL END_Z1 END_Z1_SLOPE END_DEPTH END_DEPTH_SLOPE "
    "DRAW BASE_COSINE BASE_SINE ACROSS MOST SWAYS SWAY SWAY_SLOPE SWAY_CURVE SWAY_JERK JERK_BOUND "
    "APART PUSH ROUGH SLIDE BEND STICKS STUCK HELD_Z2 LIMIT TURN"
).split()
# Parameters that `friction.hold` changes if the loose mass sticks. Rows FREE keep the old values.
HELD = ["DAMPING", "STIFFNESS", *map(str.upper, NONLINEAR), "CONTACT_STIFFNESS", "DASHPOT"]
FREE = [f"FREE_{name}" for name in HELD]
SINGLE = list(packed.NAMES) + STATE + STEP + SCRATCH + FREE
SERIES = "X Q G U E H D".split()
TANGENT_SERIES = "DX DQ".split()
IMPORTS = f"""import math
import numpy as np
from {branches.__name__} import bits, number, template
from {equation.__name__} import forcing_amplitude, spring, spring_slope
from {straight.__module__} import {straight.__name__}
"""
# Largest number of series that one kernel sums.
SUMS = 6
# COSINES has the coefficients of x^0, x^2, x^4, ... in (cos x - 1)/x^2, SINES in (sin x - x)/x^3.
COSINES = [(-1.0) ** k / math.factorial(2 * k) for k in range(1, 9)]
SINES = [(-1.0) ** k / math.factorial(2 * k + 1) for k in range(1, 9)]


def instance(lanes, flight_order=FLIGHT_ORDER, contact_order=CONTACT_ORDER):
    """Return the generated module for a number of lanes and for the orders of the series."""
    name = f"impact_damper_step_{lanes}_{flight_order}_{contact_order}"
    if name in sys.modules:
        return sys.modules[name]
    path = CACHE_DIRECTORY / f"{name}.py"
    if not path.exists():
        part = path.with_name(f"{path.name}.part-{os.getpid()}")
        part.write_text(_source(Source(lanes, flight_order, contact_order)))
        os.replace(part, path)
    specification = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    sys.modules[name] = module
    return module


def _source(writer):
    constants = {
        "LANES": writer.lanes,
        "TANGENTS": writer.tangents,
        "FLIGHT_ORDER": writer.orders["flight"],
        "CONTACT_ORDER": writer.orders["contact"],
        # `step.predict_length` uses the Taylor coefficients of orders EARLY to EARLY + 2.
        "EARLY": 3 * (writer.orders["flight"] - 1) // 5 + 1,
        "SIZE": writer.rows["ROWS"] * writer.lanes,
        "TANGENT_SIZE": writer.rows["TANGENT_ROWS"] * writer.tangents,
        "KEPT": len(STATE) * writer.tangents,
    }
    constants |= {name: writer.rows[name] * writer.lanes for name in [*SINGLE, *SERIES]}
    for name, held in (("HELD_ROWS", HELD), ("FREE_ROWS", FREE)):
        constants[name] = tuple(writer.rows[each] * writer.lanes for each in held)
    lines = "".join(f"{name} = {value}\n" for name, value in constants.items())
    templates = forcing, root_search, across, friction, contact, separation, step
    text = "\n\n".join([lines, writer.text(), *map(inspect.getsource, templates)])
    # Templates with the argument `a`, or `a` and `d`, are wrapped, so that kernels can call them.
    # The pattern leaves out functions that begin with a loop: `straight` compiles them.
    pattern = r"^def (\w+)\((a|a, d)\):$(?!\n    for i in range\(\d+\):)"
    for name, arguments in re.findall(pattern, text, re.MULTILINE):
        text += f"\n\ndef call_{name}({arguments}):\n    {name}({arguments})\n"
        text += f"\n\n{name} = template({name}, call_{name})\n"
    return text


def rows(flight_order, contact_order):
    """Return a dictionary with the index of each named row in the array of a step.

    A series has a row for each order. Its name stands for the first of these rows. PARTS is the
    first row of partial sums. Two entries are no indices: ROWS is the number of rows in the array
    of a step, and TANGENT_ROWS is the number of rows in the array of tangents.
    """
    length = max(flight_order, contact_order) + 1
    single = {name: number for number, name in enumerate(SINGLE)}
    series = {name: len(SINGLE) + length * j for j, name in enumerate(SERIES)}
    tangent = {name: len(STATE) + 1 + length * j for j, name in enumerate(TANGENT_SERIES)}
    ends = {
        "PARTS": len(SINGLE) + length * len(SERIES),
        "ROWS": len(SINGLE) + length * len(SERIES) + 4 * SUMS,
        "TANGENT_ROWS": len(STATE) + 1 + length * len(TANGENT_SERIES),
    }
    return single | series | tangent | ends


class Writer:
    """Writes the source code of kernels that compute Taylor series.

    With one lane the kernels compute up to four tangents, otherwise one tangent in each lane.
    """

    def __init__(self, lanes, flight_order, contact_order):
        self.lanes = lanes
        self.tangents = lanes if lanes > 1 else 4
        self.orders = {"flight": flight_order, "contact": contact_order}
        self.rows = rows(flight_order, contact_order)

    def at(self, row, k=0):
        """Return code such as "a[48 + i]": the entry for lane i, k rows after the row `row`."""
        index = (self.rows[row] + k) * self.lanes
        return f"a[{index} + i]" if self.lanes > 1 else f"a[{index}]"

    def at_tangent(self, row, k=0):
        """Return code such as "d[8 + i]": the entry for tangent i, k rows after the row `row`."""
        return f"d[{(self.rows.get(row, 0) + k) * self.tangents} + i]"

    def function(self, name, lines, tangent=False, first=(), side_by_side=4):
        """Return the source code of a kernel that executes the lines of code `lines`.

        The kernel has the argument `a`, and executes the lines for each lane. If `tangent` is true,
        it has the arguments `a` and `d`, and executes the lines for each tangent. With one lane, it
        may begin with other lines, `first`. Each line of `first` computes `side_by_side` numbers at
        once, in a vector of the processor.
        """
        arguments, lanes = ("a, d", self.tangents) if tangent else ("a", self.lanes)
        text, calls = "", ""
        for part, count, body in (("first", side_by_side, first), ("lines", lanes, lines)):
            if body:
                text += f"@straight\ndef {name}_{part}({arguments}):\n"
                text += f"    for i in range({count}):\n"
                text += "".join(f"        {line}\n" for line in body) + "\n\n"
                calls += f"    {name}_{part}({arguments})\n"
        return f"{text}def {name}({arguments}):\n{calls}"

    def moving(self, phase):
        """Return "X" (the series of Z1), or in contact "XQ" (the series of Z1 and of the depth)."""
        return "XQ" if phase == "contact" else "X"

    def constant_series(self):
        """Return the code of a kernel that computes the series that depend on parameters only."""
        lines = (self._computed(k, "EHD") for k in range(max(self.orders.values()) - 1))
        return self.function("constant_series", self._stored(chain.from_iterable(lines), "EHD"))

    def _computed(self, k, names):
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
        names = ("" if tangent else "E") + ("HD" if phase == "contact" else "H")
        if self.lanes > 1:  # a lane can get another trajectory before each step
            return lambda k: self._computed(k, names)
        return lambda k: [f"{name.lower()}{k} = {self.at(name, k)}" for name in names]

    def series(self, phase, across=False):
        """Return the code of a kernel that computes the Taylor series of a step.

        X is the series of Z1, and G is the series of Z1'' without the wall's force. In contact Q is
        the series of the depth. Q includes gravity, friction and a moving base if `across` is true.
        """
        lines = [
            f"cosine = {self.at('COSINE')}",
            f"sine = {self.at('SINE')}",
            f"x0 = {self.at('Y0')}",
            # Without + 0.0 LLVM would load x0 and x1 as one vector. The processor would then wait
            # until both numbers have been stored.
            f"x1 = {self.at('Y1')} + 0.0",
            f"push = {self.at('PUSH')}",
            *equation.beginning(self.at),
            *self._factors(phase),
        ]
        if phase == "contact":
            lines += [
                f"q0 = {self.at('Y2')} - {self.at('SIDE')} * {self.at('CLEARANCE')}",
                f"q1 = {self.at('Y3')}",
            ]
        if across:
            lines += [
                f"draw = {self.at('DRAW')}",
                f"base_cosine = {self.at('BASE_COSINE')}",
                f"base_sine = {self.at('BASE_SINE')}",
            ]
        constants = self._constants(phase, tangent=False)
        lines += equation.motion(self.orders[phase], phase, constants, across)
        name = f"{phase}_series_across" if across else f"{phase}_series"
        return self.function(name, self._stored(lines, f"{self.moving(phase)}G"))

    def squares(self, phase):
        """Return code of a kernel that computes the series of 3 k3 Z1^2 from the series of Z1."""
        count = self.orders[phase] - 1
        lines = list(equation.coefficients(self.at))
        lines += [f"x{k} = {self.at('X', k)}" for k in range(count)]
        lines += self._stored(equation.squares(count), "U")
        return self.function(f"{phase}_squares", lines)

    def tangent_series(self, phase):
        """Return the code of a kernel that computes the Taylor series of tangents in a step."""
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
            *equation.tangent(order, phase, self._constants(phase, tangent=True)),
        ]
        lines = self._stored(lines, names, tangent=True)
        return self.function(f"{phase}_tangent_series", lines, tangent=True)

    def _factors(self, phase):
        if phase == "contact":
            yield f"r1 = {self.at('CONTACT_STIFFNESS')}"
            yield f"mobility = 1.0 + {self.at('INVERSE_MASS_RATIO')}"

    def _stored(self, lines, names, tangent=False):
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


class Source(Writer):
    """Writes all kernels that the templates call, for series, sums of series, and bounds."""

    def text(self):
        """Return the source code of all kernels, with their imports."""
        slope = {"Z1": "X", "Z1_SLOPE": "X'"}
        curve = {"Z1_CURVE": "G"}
        jerk = curve | {"Z1_JERK": "G'"}
        depth = {"DEPTH": "Q", "DEPTH_SLOPE": "Q'"}
        bound = {"BOUND": "|G|"}
        early = max(4, self.orders["flight"] // 2)
        changed = [f"{self.at('CHANGE')} = t * {self.at('CHANGE')}"]
        functions = [
            *([self.constant_series()] if self.lanes == 1 else []),
            self.circular(),
            *(self.series(phase) for phase in self.orders),
            self.series("contact", across=True),
            *(self.squares(phase) for phase in self.orders),
            *(self.tangent_series(phase) for phase in self.orders),
            *(self.tangent_value(phase) for phase in self.orders),
            self.sums("flight_slope", "flight", "T", slope, self._tail("flight")),
            self.sums("flight_early", "flight", "T", slope | curve, terms=early),
            self.sums("flight_curve", "flight", "T", jerk),
            self.sums("contact_values", "contact", "T", slope | jerk | depth, self._wall()),
            # Upper bounds on |g|, |g'| and |g''|, where g is Z1'' without the wall's force.
            self.sums("flight_bound", "flight", "LENGTH", bound),
            self.sums("flight_jerk", "flight", "LENGTH", {"JERK_BOUND": "|G'|"}),
            self.sums("flight_snap", "flight", "T", {"SNAP": "|G''|"}),
            self.sums("contact_jerk", "contact", "LENGTH", {"Z1_JERK": "|G'|"}),
            self.sums("contact_bound", "contact", "LENGTH", bound, self._tail("contact")),
            # CHANGE is an upper bound on |Z1'(t) - Z1'(0)| for 0 <= t <= T. It is the sum of
            # |k x[k]| T^(k - 1) over k >= 2, where x[k] is Taylor coefficient k of Z1.
            self.sums("flight_change", "flight", "T", {"CHANGE": "|X'|"}, changed, begin=2),
        ]
        return f"{IMPORTS}\n\n" + "\n\n".join(functions)

    def sums(self, name, phase, time, results, then=(), begin=0, terms=99):
        """Return the source code of a kernel that sums Taylor series.

        The series are summed at the time that the row named `time` has. In `results` a key is the
        name of the row for a sum, and its value is the series: "X" is the series X, "X'" its first
        derivative, and "|X|" the series of the moduli of its terms. A sum begins with coefficient
        `begin` of X, also if X' is summed, and has at most `terms` terms. Each sum is divided by
        the power of t in its first term. The kernel ends with the lines of code `then`.
        """
        lines = [*self._time(time, phase)]
        first = list(lines) if self.lanes == 1 else []
        for number, (result, series) in enumerate(results.items()):
            start = max(begin, series.count("'"))
            last = self.orders[phase] - (2 if "G" in series else 0)
            orders = range(start, last + 1)[:terms]
            coefficients = [self._coefficient(series, k) for k in orders]
            parts, done = coefficients[:4], 4
            if self.lanes == 1:
                parts = [f"a[{self.rows['PARTS'] + 4 * number + j}]" for j in range(4)]
                done = len(orders) // 4 * 4
                first += self._parts(series, orders[:done], parts)
            lines += _sum(coefficients, self.at(result), parts, done)
        return self.function(name, [*lines, *then], first=first)

    def _parts(self, series, orders, parts):
        for k in orders[::4]:
            four = self._coefficient(series, *range(k, k + 4))
            power = k - orders[0]
            yield f"part = part + {four} * t{power}" if power else f"part = {four}"
        yield f"{_widened(parts[0])} = part"

    def circular(self):
        """Return the code of a kernel that sums the series COSINES and SINES at x = ANGLE."""
        cosine, sine = self.at("CIRCLE_COSINE"), self.at("CIRCLE_SINE")
        angle = [f"t = {self.at('ANGLE')}", "u = t * t", "v = u * u"]
        if self.lanes == 1:
            both = list(map(_constants, COSINES, SINES))
            first = [*angle, _paired(both, _widened(cosine))]
            return self.function("circular_series", [], first=first, side_by_side=2)
        lines = [*angle, _paired(COSINES, cosine), _paired(SINES, sine)]
        return self.function("circular_series", lines)

    def _coefficient(self, series, *orders):
        number = self.at(series.strip("'|"), orders[0])
        if len(orders) > 1:
            number = _widened(number)
        if derivative := series.count("'"):
            factors = [float(math.perm(k, derivative)) for k in orders]
            number = f"{_constants(*factors)} * {number}"
        return f"abs({number})" if series.startswith("|") else number

    def _wall(self):
        mobility = f"(1.0 + {self.at('INVERSE_MASS_RATIO')})"
        for force, depth_row, rate, derivative in (
            ("force", "DEPTH", "DEPTH_SLOPE", "CURVE"),
            ("rise", "DEPTH_SLOPE", "DEPTH_CURVE", "JERK"),
        ):
            stiff, lossy = self.at("CONTACT_STIFFNESS"), self.at("DASHPOT")
            z1, depth = self.at(f"Z1_{derivative}"), self.at(f"DEPTH_{derivative}")
            yield f"{force} = {stiff} * {self.at(depth_row)} + {lossy} * {self.at(rate)}"
            sway = self.at(f"SWAY_{derivative}")
            yield f"{depth} = {z1} + {sway} - {mobility} * {force}"
            yield f"{z1} -= {force}"

    def _tail(self, phase):
        # The lines set TAIL to the largest modulus of the last two terms in the series of Z1' at
        # the time t. In contact the last two terms of the depth's rate count too.
        last = self.orders[phase]
        yield "last = 0.0"
        for row in self.moving(phase):
            yield f"last = max(last, abs({float(last - 1)} * {self.at(row, last - 1)}))"
            yield f"last = max(last, abs({float(last)} * {self.at(row, last)}) * t)"
        power = last - 2
        factors = [f"t{power - power % 4}"] if power > 3 else []
        factors += (["t2"] if power % 4 > 1 else []) + (["t"] if power % 2 else [])
        yield f"{self.at('TAIL')} = {' * '.join(['last', *factors])}"

    def tangent_value(self, phase):
        """Return the code of a kernel that computes tangents at time T, from their series."""
        lines = [*self._time("T", phase)]
        for number, name in enumerate(self.moving(phase)):
            terms = [self.at_tangent(f"D{name}", k) for k in range(self.orders[phase] + 1)]
            slopes = [f"{float(k)} * {term}" for k, term in enumerate(terms)][1:]
            lines += _sum(terms, self.at_tangent("", 2 * number), terms[:4], 4)
            lines += _sum(slopes, self.at_tangent("", 2 * number + 1), slopes[:4], 4)
        return self.function(f"{phase}_tangent_value", lines, tangent=True)

    def _time(self, row, phase):
        yield f"t = {self.at(row)}"
        yield "t2 = t * t"
        yield "t4 = t2 * t2"
        for k in range(8, self.orders[phase] + 1, 4):
            half = 4 * (k // 8)
            yield f"t{k} = t{half} * t{k - half}"


def _widened(number):
    return number.replace("]", " + i]")


def _constants(*numbers):
    return f"{numbers}[i]" if len(numbers) > 1 else repr(numbers[0])


def _paired(c, result):
    low, high = (f"({a} + {b} * u) + ({c} + {d} * u) * v" for a, b, c, d in (c[:4], c[4:]))
    return f"{result} = ({low}) + ({high}) * (v * v)"


def _sum(c, result, parts, done):
    # The lines set `result` to the sum of c[k] t^k. The variable part{j} sums c[k] t^(k - j) over
    # k = j, j + 4, ... It begins with `parts[j]`, the code of its terms with k < `done`.
    for j in range(4):
        yield f"part{j} = {parts[j]}"
        for k in range(done + j, len(c), 4):
            yield f"part{j} = part{j} + {c[k]} * t{k - j}"
    yield f"{result} = (part0 + t * part1) + t2 * (part2 + t * part3)"
