"""Values of the series of a step at a time in it, and bounds on them."""

from impact_damper.series import Writer
from impact_damper.straight import straight


class Source(Writer):
    """Writes what `events` and `step` call: the series, and what is read off them."""

    def text(self):
        """The module."""
        slope = {"Z1": "X", "Z1_SLOPE": "V"}
        curve = slope | {"Z1_CURVE": "G"}
        jerk = curve | {"Z1_JERK": "G'"}
        depth = {"DEPTH": "Q", "DEPTH_SLOPE": "W"}
        functions = [
            *([self.drive()] if self.lanes == 1 else []),
            *(self.series(phase) for phase in self.orders),
            *(self.tangent_series(phase) for phase in self.orders),
            *(self.tangent_value(phase) for phase in self.orders),
            self.values("flight_slope", "flight", slope, self._tail("flight", "V")),
            self.values("flight_early", "flight", curve, terms=max(4, self.orders["flight"] // 2)),
            self.values("flight_values", "flight", jerk),
            self.values("contact_values", "contact", jerk | depth, self._wall()),
            self.bound("flight"),
            self.bound("contact", self._tail("contact", "VW")),
            self.change(),
        ]
        imports = [
            "from impact_damper.accelerate import kernel",
            f"from {straight.__module__} import {straight.__name__}\n",
        ]
        return "\n".join(imports) + "\n\n" + "\n\n".join(functions)

    def values(self, name, phase, results, then=(), terms=99):
        """Sums of series at T, and what follows; `results` gives each sum's row, and its series.

        The slope of a series is written with a prime. Of each series only so many terms are taken.
        """
        lines = [*self._time("T", phase)]
        for result, row in results.items():
            count = min(self.filled(phase)[row[0]] + 1, terms)
            coefficients = [self.at(row[0], k) for k in range(count)]
            if row.endswith("'"):
                coefficients = [f"{float(k)} * {c}" for k, c in enumerate(coefficients)][1:]
            lines += _sum(coefficients, self.at(result))
        return self.function(name, [*lines, *then])

    def _wall(self):
        """What the wall adds: to G and its slope, for those of Z1 and of the penetration."""
        mobility = f"(1.0 + {self.at('INVERSE_MASS')})"
        for force, place, rate, given in (
            ("force", "DEPTH", "DEPTH_SLOPE", "CURVE"),
            ("rise", "DEPTH_SLOPE", "DEPTH_CURVE", "JERK"),
        ):
            stiff, lossy = self.at("CONTACT"), self.at("DASHPOT")
            z1, depth = self.at(f"Z1_{given}"), self.at(f"DEPTH_{given}")
            yield f"{force} = {stiff} * {self.at(place)} + {lossy} * {self.at(rate)}"
            yield f"{depth} = {z1} - {mobility} * {force}"
            yield f"{z1} -= {force}"

    def _tail(self, phase, series):
        """TAIL becomes the largest of the last two terms of series at t."""
        last = self.orders[phase] - 1
        yield "last = 0.0"
        for row in series:
            yield f"last = max(last, abs({self.at(row, last - 1)}))"
            yield f"last = max(last, abs({self.at(row, last)}) * t)"
        power = last - 1
        factors = [f"t{power - power % 4}"] if power > 3 else []
        factors += (["t2"] if power % 4 > 1 else []) + (["t"] if power % 2 else [])
        yield f"{self.at('TAIL')} = {' * '.join(['last', *factors])}"

    def bound(self, phase, then=()):
        """BOUND on |g| over the LENGTH of the step, which in flight is a bound on |Z1''|."""
        coefficients = [f"abs({self.at('G', k)})" for k in range(self.orders[phase] - 1)]
        lines = [*self._time("LENGTH", phase), *_sum(coefficients, self.at("BOUND")), *then]
        return self.function(f"{phase}_bound", lines)

    def change(self):
        """CHANGE: what the terms of Z1' but the first come to, at most, over a flight's LENGTH."""
        coefficients = [f"abs({self.at('V', k)})" for k in range(1, self.orders["flight"])]
        lines = [*self._time("LENGTH", "flight")]
        lines += [*_sum(coefficients, "change"), f"{self.at('CHANGE')} = change * t"]
        return self.function("flight_change", lines)

    def tangent_value(self, phase):
        """The tangent at T."""
        lines = [*self._time("T", phase)]
        for place, (name, last) in enumerate(self.filled_of_tangent(phase).items()):
            coefficients = [self.at_tangent(f"D{name}", k) for k in range(last + 1)]
            lines += _sum(coefficients, self.at_tangent("", place))
        return self.function(f"{phase}_tangent_value", lines, tangent=True)

    def _time(self, row, phase):
        """The t of a row, and its powers for `_sum`."""
        yield f"t = {self.at(row)}"
        yield "t2 = t * t"
        yield "t4 = t2 * t2"
        for k in range(8, self.orders[phase] + 1, 4):
            half = 4 * (k // 8)
            yield f"t{k} = t{half} * t{k - half}"


def _sum(c, result):
    """Lines that add up a series at t: every fourth power apart, side by side, then together.

    From the first terms on: the last coefficients of a step are the last to be known.
    """
    for j in range(4):
        yield f"part{j} = {c[j]}"
        for k in range(j + 4, len(c), 4):
            yield f"part{j} = part{j} + {c[k]} * t{k - j}"
    yield f"{result} = (part0 + t * part1) + t2 * (part2 + t * part3)"
