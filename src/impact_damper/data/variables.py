"""Registry of the variables in all datasets: name, dimensions, physical kind, symbol, flags."""

import re
from typing import NamedTuple

# A bar between spaces separates cells; the bars of "max |Z1|" do not.
BAR = re.compile(r"(?<!\S)\|(?!\S)")


class Variable(NamedTuple):
    """One variable of the datasets; `long_name` is also the text of an axis label.

    `kind`, for the unit in datasets of machines, is a key of `model.units.QUANTITIES`, "state" for
    displacements and velocities, "followed" for the parameter that varies, or "mixed" for a number
    of several kinds, such as the distance of two states.
    """

    dims: tuple
    long_name: str
    symbol: str = ""
    kind: str = "number"
    flags: dict | None = None

    @property
    def units(self) -> str:
        """Unit in datasets of an `Oscillator`: "1", or "radian" for an angle."""
        return "radian" if self.kind == "angle" else "1"


VARIABLES: dict[str, Variable] = {}


def register(table, **flags) -> None:
    """Add variables to the registry; a name that is registered already is an error.

    The table has for each variable a line "name | dimensions | kind | symbol | description",
    without a kind for a plain number. An indented line continues the description, or names the
    values of the variable: "  : absent 0, found 1", or "  : STATUS" for the flags `STATUS`. "#"
    begins a comment.
    """
    entries = []
    for line in table.splitlines():
        text = line.strip()
        if not text or text.startswith("#"):
            continue
        if not line.startswith("  "):
            entries.append([text, ""])
        elif text.startswith(":"):
            entries[-1][1] += text[1:]
        else:
            entries[-1][0] += f" {text}"
    for entry, values in entries:
        name, dims, kind, symbol, words = map(str.strip, BAR.split(entry, 4))
        if name in VARIABLES:
            raise ValueError(f"{name}: registered twice")
        VARIABLES[name] = Variable(
            tuple(dims.split()), words, symbol, kind or "number", _named_values(values, flags)
        )


def _named_values(text, shared):
    """Return the flags that a text such as "absent 0, found 1" or "STATUS" describes, or None."""
    text = text.strip()
    if not text:
        return None
    if text in shared:
        return shared[text]
    pairs = (each.split() for each in text.rstrip(",").split(","))
    return {name: int(value) for name, value in pairs}


STABILITY = {"absent": -2, "unstable": -1, "marginal": 0, "stable": 1}
# Outcome of a motion:
# absent          there is no motion in this place of the array
# unresolved      the run ended before the outcome was certain
# settled         on a stable periodic orbit, with contacts or without a damper
# diverged        the state is no longer finite
# non_colliding   settled, and the loose mass touches no wall
# escaped         over the barrier of a softening spring
# at_rest         a motion without forcing has come to rest
# drifting        the primary mass is on an orbit; the loose mass drifts and touched no wall so far
OUTCOME = {
    "absent": -1,
    "unresolved": 0,
    "settled": 1,
    "chaotic": 2,
    "diverged": 3,
    "non_colliding": 4,
    "escaped": 5,
    "at_rest": 6,
    "quasi_periodic": 7,
    "drifting": 8,
}
# Kind of a minimum; it jumps at the end of a branch, and the edge is the end of the sweep.
MINIMUM = {"not_found": 0, "smooth": 1, "kink": 2, "jump": 3, "edge": 4}
# Kinds of motions with the damper. A motion of period 1 is quiet if it is smaller than half the
# motion at resonance without the damper, and violent otherwise.
DAMPED_MOTION = {"none": -1, "unsettled": 0, "quiet": 1, "violent": 2, "subharmonic": 3}
# Kinds of motions without the damper.
FREE_MOTION = {
    "none": -1,
    "unresolved": 0,
    "non_resonance": 1,
    "resonance": 2,
    "subharmonic": 3,
    "other": 4,
}
# Events that end a branch of motions.
END = {
    "not_smooth": 0,
    "fold": 1,
    "symmetry_breaking": 2,
    "period_doubling": 3,
    "neimark_sacker": 4,
}
# Labels of states without attractor; `mixed` if the place of the loose mass decides.
BASIN_LABEL = {
    "unresolved": -1,
    "escaped": -2,
    "chaotic": -3,
    "no_contact": -4,
    "mixed": -5,
    "quasi_periodic": -6,
}
