"""Generate the source of kernels that evaluate the Taylor series of a step, and bounds on them.

A lane holds one of several trajectories that are integrated side by side. Symbols are as in
`system.parameters`.
"""

import math

from impact_damper.kernel.series import Writer
from impact_damper.kernel.straight_lines import straight

# Coefficients of (cos x - 1)/x^2 and (sin x - x)/x^3 in powers of x^2.
COSINES = [(-1.0) ** k / math.factorial(2 * k) for k in range(1, 9)]
SINES = [(-1.0) ** k / math.factorial(2 * k + 1) for k in range(1, 9)]


class Source(Writer):
    """Writes the kernels that the templates call: series, their sums, bounds on their values.

    The names in capitals are names of rows (see `series.rows`).
    """

    def text(self):
        """Return the source of all kernels, with their imports."""
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
            *(self.squares(phase) for phase in self.orders),
            *(self.tangent_series(phase) for phase in self.orders),
            *(self.tangent_value(phase) for phase in self.orders),
            self.sums("flight_slope", "flight", "T", slope, self._tail("flight")),
            self.sums("flight_early", "flight", "T", slope | curve, terms=early),
            self.sums("flight_curve", "flight", "T", jerk),
            self.sums("contact_values", "contact", "T", slope | jerk | depth, self._wall()),
            # Upper bounds on |g|. In flight g is Z1''.
            self.sums("flight_bound", "flight", "LENGTH", bound),
            self.sums("contact_bound", "contact", "LENGTH", bound, self._tail("contact")),
            # An upper bound on the change of Z1': the sum of the moduli of its terms after the
            # first.
            self.sums("flight_change", "flight", "T", {"CHANGE": "|X'|"}, changed, begin=2),
        ]
        imports = [
            "from impact_damper.kernel.compiling import kernel_only",
            f"from {straight.__module__} import {straight.__name__}\n",
        ]
        return "\n".join(imports) + "\n\n" + "\n\n".join(functions)

    def sums(self, name, phase, time, results, then=(), begin=0, terms=99):
        """Return a kernel that sums series at a time.

        Parameters
        ----------
        name : str
            Name of the kernel.
        phase : str
            "flight" or "contact".
        time : str
            Row of the time.
        results : dict of str
            Maps the row of each result to its series: "X" for the sum of the series X, "X'" for the
            derivative of the sum, "|X|" for the sum of the moduli of the terms.
        then : iterable of str
            Lines that the kernel executes after the sums.
        begin, terms : int
            First order of a sum, and the largest number of its terms.

        Each sum is split into four partial sums, each of every fourth term, which the processor can
        compute at the same time. With one lane, the four partial sums stand in one vector register.
        """
        lines = [*self._time(time, phase)]
        first = list(lines) if self.lanes == 1 else []
        for number, (result, series) in enumerate(results.items()):
            start = max(begin, 1 if "'" in series else 0)
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
        """Yield lines that compute the four partial sums of a series in one vector register."""
        for k in orders[::4]:
            four = self._coefficient(series, *range(k, k + 4))
            power = k - orders[0]
            yield f"part = part + {four} * t{power}" if power else f"part = {four}"
        yield f"{_widened(parts[0])} = part"

    def circular(self):
        """Return a kernel that sums the series COSINES and SINES at ANGLE.

        The results are stored in COSINE and SINE. With one lane both sums stand in one vector
        register.
        """
        cosine, sine = self.at("COSINE"), self.at("SINE")
        angle = [f"t = {self.at('ANGLE')}", "u = t * t", "v = u * u"]
        if self.lanes == 1:
            both = list(map(_constants, COSINES, SINES))
            first = [*angle, _paired(both, _widened(cosine))]
            return self.function("circular_series", [], first=first, side_by_side=2)
        lines = [*angle, _paired(COSINES, cosine), _paired(SINES, sine)]
        return self.function("circular_series", lines)

    def _coefficient(self, series, *orders):
        """Return the expression for one coefficient of a series, or for a vector of four."""
        number = self.at(series.strip("'|"), orders[0])
        if len(orders) > 1:
            number = _widened(number)
        if "'" in series:
            number = f"{_constants(*map(float, orders))} * {number}"
        return f"abs({number})" if series.startswith("|") else number

    def _wall(self):
        """Yield lines for the second and third derivatives of Z1 and of the penetration.

        Before these lines Z1_CURVE and Z1_JERK hold g and g'. The lines subtract the force of the
        wall and the rate of this force. "Curve" is a second derivative, "jerk" a third.
        """
        mobility = f"(1.0 + {self.at('INVERSE_MASS_RATIO')})"
        for force, depth_row, rate, derivative in (
            ("force", "DEPTH", "DEPTH_SLOPE", "CURVE"),
            ("rise", "DEPTH_SLOPE", "DEPTH_CURVE", "JERK"),
        ):
            stiff, lossy = self.at("CONTACT_STIFFNESS"), self.at("DASHPOT")
            z1, depth = self.at(f"Z1_{derivative}"), self.at(f"DEPTH_{derivative}")
            yield f"{force} = {stiff} * {self.at(depth_row)} + {lossy} * {self.at(rate)}"
            yield f"{depth} = {z1} - {mobility} * {force}"
            yield f"{z1} -= {force}"

    def _tail(self, phase):
        """Yield lines that store in TAIL the largest of the last two terms of the velocities."""
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
        """Return a kernel that evaluates a tangent (solution of the variational equations) at T."""
        lines = [*self._time("T", phase)]
        for number, name in enumerate(self.moving(phase)):
            terms = [self.at_tangent(f"D{name}", k) for k in range(self.orders[phase] + 1)]
            slopes = [f"{float(k)} * {term}" for k, term in enumerate(terms)][1:]
            lines += _sum(terms, self.at_tangent("", 2 * number), terms[:4], 4)
            lines += _sum(slopes, self.at_tangent("", 2 * number + 1), slopes[:4], 4)
        return self.function(f"{phase}_tangent_value", lines, tangent=True)

    def _time(self, row, phase):
        """Yield lines for the time t in a row, and for the powers of t that `_sum` needs."""
        yield f"t = {self.at(row)}"
        yield "t2 = t * t"
        yield "t4 = t2 * t2"
        for k in range(8, self.orders[phase] + 1, 4):
            half = 4 * (k // 8)
            yield f"t{k} = t{half} * t{k - half}"


def _widened(number):
    """Return the expression for the vector that begins with a number of the array."""
    return number.replace("]", " + i]")


def _constants(*numbers):
    """Return the expression for a constant, or for a vector of constants."""
    return f"{numbers}[i]" if len(numbers) > 1 else repr(numbers[0])


def _paired(c, result):
    """Return a line that sums eight terms c[k] u^k by Estrin's scheme, with v = u^2."""
    low, high = (f"({a} + {b} * u) + ({c} + {d} * u) * v" for a, b, c, d in (c[:4], c[4:]))
    return f"{result} = ({low}) + ({high}) * (v * v)"


def _sum(c, result, parts, done):
    """Yield lines that sum a series at t in four partial sums, and then add the partial sums.

    Each partial sum has every fourth term, and `parts` already contain the first `done` terms.
    Terms are added in rising order, because the last coefficients of a step are computed last.
    """
    for j in range(4):
        yield f"part{j} = {parts[j]}"
        for k in range(done + j, len(c), 4):
            yield f"part{j} = part{j} + {c[k]} * t{k - j}"
    yield f"{result} = (part0 + t * part1) + t2 * (part2 + t * part3)"
