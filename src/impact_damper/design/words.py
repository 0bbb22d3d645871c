"""The conclusion of a design in sentences; each number comes from the datasets of the design.

A start is a random initial state. A motion is quiet if its largest displacement is at most the
quiet limit. The cliff is the gap beyond which fewer starts lead to quiet motions. A corner is a set
of values in which each deviates by its whole tolerance.
"""

import numpy as np

from impact_damper.data.datasets import decode, flag
from impact_damper.data.sweeps import quiet_gaps, stable_range
from impact_damper.design.cliff import HOLDABLE, LEAD, LONGEST
from impact_damper.design.deviations import UNSEEN
from impact_damper.design.remarks import excitations, pulling_walls, tried_restitutions
from impact_damper.design.task import LATER

# First sentence, by the kind of choice (`choose.Choice`) or the result of the check.
SUMMARY = {
    "robust": ("{build}; any gap from {low:.3g} to {high:.3g} mm will do. {promise} {worst}"),
    "nominal": (
        "{build}, and hold all values more closely than their tolerances: gaps from {low:.3g} to "
        "{high:.3g} mm will do only if all other values are as given. {promise} {worst}"
    ),
    "needs_tolerance": "{build} and hold it from {edges} mm{narrow}. {promise} {worst}",
    "least_worst": (
        "No range of gaps that one can hold (at least {holdable} of the gap) is quiet over the "
        "whole band. The gap of {gap:.3g} mm, with walls of restitution {restitution:.3g}, is the "
        "least bad: {worst}, instead of {bare:.3g} mm without the damper. {fewest} of the starts "
        "lead to quiet motions at the worst frequency, but at least {share} are required. Do not "
        "build this damper for this band."
    ),
    "broken": (
        "Do not build this damper: the check with new random starts failed. The gap chosen was "
        "{gap:.3g} mm, with walls of restitution {restitution:.3g}. {worst}"
    ),
}
BUILD = (
    "Build a gap of {gap:.3g} mm (full play, from wall to wall), with walls of restitution "
    "{restitution:.3g}"
)
PROMISE = (
    "The machine then moves at most {limit:.3g} mm, instead of {bare:.3g} mm without the damper. "
    "At each frequency of the band at least {share} of all starts, however machine and loose mass "
    "begin to move, lead to such a quiet motion, at 95 % confidence."
)
# Second sentence, by the result of the check (`deviations.promise`).
VERDICTS = {
    "none_made": "Nothing is promised.",
    "nominal_kept": (
        "In a check with new random starts the promise held at the nominal values. "
        "Nothing is promised for other values."
    ),
    "robust_kept": (
        "In a check with new random starts the promise held, at the nominal values and at the "
        "corners of the tolerances."
    ),
    "broken": "In a check with new random starts the promise did NOT hold: do not rely on it.",
}


def conclusion(task, kind, data) -> list[str]:
    """Return the conclusion as sentences.

    Parameters
    ----------
    task : Task
    kind : str
        Kind of the choice of the gap, see `choose.Choice`.
    data : xarray.Dataset
        Result of `stages.machines.design_damper` before the conclusion is added.
    """
    gap = float(data["design_gap"])
    tolerance = task.tolerances.get("gap", 0.0)
    edges = data["cliff_gap"].values
    ends = gap * (1 - tolerance), gap * (1 + tolerance)
    # The kind was decided with the compared gaps. The cliff is located more finely, so the range
    # may turn out to be as wide as the tolerance.
    narrow = edges[0] > ends[0] or edges[1] < ends[1]
    checked = decode(data["promise"]).item()
    limit = float(data["displacement_limit"])
    numbers = {
        "gap": gap,
        "restitution": task.restitution,
        "limit": limit,
        "share": _percent(task.share),
        "fewest": _percent(data["reached_quiet_share"].min()),
        "low": ends[0],
        "high": ends[1],
        "narrow": f", a narrower range than the tolerance of {_percent(tolerance)}"
        if narrow
        else "",
        "edges": quiet_gaps(data),
        "holdable": _percent(HOLDABLE),
        "bare": float(data["balance_displacement"].max()),
        "worst": _worst(kind, data),
    }
    numbers |= {"build": BUILD.format(**numbers), "promise": PROMISE.format(**numbers)}
    summary = {"broken": "broken", "nominal_kept": "nominal" if kind == "robust" else kind}
    found = [SUMMARY[summary.get(checked, kind)].format(**numbers), VERDICTS[checked]]
    found += [_never_repeating(data), _sureness(data)]
    if kind == "least_worst":
        found.append(_help(task, data))
    else:
        found += [_untouched(data, gap), _margins(data, gap), _lives(data), excitations(data)]
    found += [tried_restitutions(data), pulling_walls(task.restitution), _competition(data)]
    return [sentence for sentence in found if sentence]


def _percent(share, digits=3):
    """Return a share in per cent."""
    return f"{100 * share:.{digits}g} %"


def _moves(size):
    """Return the words "moves up to ... mm", or "escapes over its barrier" for an infinite size."""
    return f"moves up to {size:.3g} mm" if np.isfinite(size) else "escapes over its barrier"


def _worst(kind, data):
    """Return a sentence on the largest motion to which starts lead."""
    size, limit = float(data["reached_displacement"].max()), float(data["displacement_limit"])
    if kind == "least_worst":
        k = int(np.argmax(data["reached_displacement"].values))
        return f"the machine {_moves(size)} at {float(data['frequency'][k]):.4g} Hz"
    if size <= limit:
        return f"From the starts tried the machine moves at most {size:.3g} mm."
    if float(data["reached_quiet_share"].min()) < 1:
        return (
            "Some starts do not lead to quiet motions: in the largest motion the machine "
            f"{_moves(size)}."
        )
    return (
        "All random starts lead to quiet motions, but slow changes of the frequency or the force, "
        "or starts on motions without the damper, lead to a larger motion, in which the machine "
        f"{_moves(size)}."
    )


def _never_repeating(data):
    """Return a sentence on motions within the quiet limit that do not count as quiet."""
    limit = float(data["displacement_limit"])
    shares = np.append(data["reached_quiet_share"].values, data["corner_share"].values[:, 0])
    sizes = np.append(data["reached_displacement"].values, data["corner_displacement"].values)
    if not ((shares < 1) & (sizes <= limit)).any():
        return ""
    return (
        f"A motion that never repeats counts as quiet only up to {limit / LATER:.3g} mm, because "
        f"its later peaks may be {LATER:.3g} times as large. Therefore starts can count as not "
        f"quiet although no motion exceeds the limit of {limit:.3g} mm."
    )


def _untouched(data, gap):
    """Return sentences on motions in which the loose mass touches no wall."""
    limit = float(data["displacement_limit"])
    size = float(np.fmax.reduce(data["untouched_displacement"].values))
    texts = []
    if gap / 2 > limit:
        texts.append(
            "At rest in the middle of the gap the loose mass is first touched when the machine "
            f"moves half the gap, {gap / 2:.3g} mm: until then the damper has no effect."
        )
    if size > limit:
        room = gap / 2 - size
        texts.append(
            "At some frequencies the machine without the damper moves less than half the gap, up "
            f"to {size:.3g} mm. If the loose mass then lies at rest within {room:.2g} mm of the "
            f"middle ({_percent(2 * room / gap, 2)} of the gap), the loose mass is not touched, "
            "and the machine moves as without the damper until the loose mass drifts. A loose mass "
            "that begins at an end of the gap is touched at once. No random start led to this "
            "motion."
        )
    return " ".join(texts)


def _sureness(data):
    """Return a sentence on the test with new starts."""
    share, sizes = data["corner_share"].values, data["corner_displacement"].values
    corners = len(share) - 1
    text = (
        f"Checked with {UNSEEN} new random starts, which the design had not used: at the nominal "
        f"values {_percent(share[0, 0])} of them lead to quiet motions (95 % interval "
        f"{_percent(share[0, 1])} to {_percent(share[0, 2])})"
    )
    if corners:
        worst = share[1:, 0].min()
        least = "all" if worst == 1 else f"at least {_percent(worst)}"
        text += (
            f", and {least} in each of {corners} further checks, in which all values were off by "
            "their whole tolerance, up or down. In the worst of these motions the machine "
            f"{_moves(sizes.max())}"
        )
    return text + "."


def _margins(data, gap):
    """Return sentences on the distances from the gap to the cliff and to the end of stability."""
    found, quiet = [], []
    for k, (side, way) in enumerate((("below", "down"), ("above", "up"))):
        edge = float(data["cliff_gap"][k])
        if int(data["cliff_status"][k]) == flag("cliff_status", "found"):
            found.append(
                f"{_percent(abs(edge / gap - 1))} {side} this gap, at {edge:.4g} mm (first at "
                f"{float(data['cliff_frequency'][k]):.4g} Hz)"
            )
        else:
            quiet.append(f"{way} to {edge:.4g} mm")
    texts = []
    if found:
        texts.append(
            "The cliff, beyond which fewer starts lead to quiet motions, lies "
            f"{' and '.join(found)}."
        )
    if quiet:
        texts.append(
            f"Gaps are quiet at least {' and '.join(quiet)}. No gap beyond was compared, so a "
            "cliff beyond is not known."
        )
    stable = stable_range(data, "gap")
    if stable:
        texts.append(
            f"The quiet orbit at {float(data['branch_frequency']):.4g} Hz is stable from {stable} "
            "mm. The gap was chosen by the share of quiet starts, not by this range."
        )
    return " ".join(texts)


def _lives(data):
    """Return sentences on gaps at which chaos is a transient and at which it lasts."""
    if "life_rate" not in data:
        return ""
    passing, lasting = [], []
    for gap, (rate, low, high) in zip(
        data["life_gap"].values, data["life_rate"].values, strict=True
    ):
        if low > 0:
            passing.append(f"{_rounded(1 / rate)} cycles at {gap:.4g} mm")
        elif np.isfinite(rate):
            lasting.append((f"{gap:.4g}", high))
    found = []
    if passing:
        found.append(
            f"Near the cliff, motions that are not quiet after {LEAD} cycles become quiet, "
            f"on average, after another {', '.join(passing)}."
        )
    if lasting:
        gaps, rates = zip(*lasting, strict=True)
        found.append(
            f"{'Motions' if passing else 'Beyond the cliff, motions'} do not become quiet at "
            f"{', '.join(gaps)} mm: none did within {LONGEST} cycles. This chaos lasts for good, "
            f"or more than {_rounded(1 / max(rates))} cycles on average."
        )
    return " ".join(found)


def _rounded(count):
    """Return a number of cycles with two digits."""
    return f"{float(f'{count:.2g}'):.0f}"


def _help(task, data):
    """Return a sentence on what would help if no gap is quiet."""
    texts = []
    good = data["other_share"].values >= task.share
    if good.any():
        mass = data["other_mass"].values[good].min()
        texts.append(f"a loose mass of {mass:.3g} kg")
    dampers = data["damper_map_share"].values
    quiet = np.argwhere(dampers >= 1)
    if len(quiet):
        row, column = quiet[-1]
        gap = float(data["map_gap"][row])
        e = float(data["map_restitution"][column])
        frequency = float(data["branch_frequency"])
        texts.append(f"at {frequency:.4g} Hz alone, a gap of {gap:.3g} mm with restitution {e:.2g}")
    if not texts:
        return (
            "None of the other masses (up to twice this one), gaps and restitutions tried gives a "
            "large enough share of quiet starts."
        )
    return f"What would help: {'; or '.join(texts)}."


def _competition(data):
    """Return a sentence on the best tuned absorber of the same mass."""
    sizes = data["competitor_displacement"].sel(force_share=1.0).max("frequency", skipna=False)
    built = sizes.sel(detuning=0.0).drop_sel(competitor="bare")
    if not np.isfinite(built).any():
        return "A tuned absorber of the same mass is not possible, or the machine escapes with it."
    name = str(built.competitor.values[int(np.nanargmin(built))])
    off = float(sizes.sel(competitor=name).max())
    return (
        f"With the best tuned absorber of the same mass the machine would move "
        f"{_short(built.min())}, and {_short(off)} with its springs 10 % off."
    )


def _short(size):
    """Return how far the machine moves (mm), as the end of a sentence."""
    return f"up to {float(size):.3g} mm" if np.isfinite(size) else "escape"
