"""The numbers of a design that its page and its conclusion show, for the templates."""

import itertools
import json
from types import SimpleNamespace

import numpy as np

from impact_damper.data.datasets import flag, named, parameters_of
from impact_damper.data.sweeps import known_range, quiet_gaps
from impact_damper.model.text import number, percent, with_unit

# The decay time of an unforced vibration is the time until it has fallen to this fraction.
DECAY = 0.1
# A range of excitations is called narrow if one of its ends differs from 1 by less than CLOSE.
CLOSE = 0.1
RIVALS = {
    "bare": "no damper",
    "this": "this impact damper",
    "tuned": "the tuned absorber",
}
# Advice for each kind of choice.
ADVICE = {
    "robust": "Build it",
    "needs_tolerance": "Build it, and hold the gap more closely than your tolerance",
    "least_worst": "Do not build it for this band",
}
# Rows of tables: names of variables or keys, descriptions, units, and factors of the units.
TABLES = {
    "GIVEN": (
        ("mass", "mass without the loose mass", "kg", 1, None),
        ("linear_stiffness", "stiffness of the spring", "N/m", 1, "stiffness"),
        ("cubic_stiffness", "cubic stiffness of the spring", "N/m³", 1, "stiffness"),
        ("damping_ratio", "damping ratio", "%", 0.01, "damping"),
        ("damping", "coefficient of the dashpot", "N s/m", 1, "damping"),
        ("force", "amplitude of the force", "N", 1, "force"),
        ("unbalance", "unbalance", "kg mm", 1e-3, "force"),
        ("base_displacement", "amplitude of the moving base", "mm", 1e-3, "force"),
        ("base_acceleration", "amplitude of the base's acceleration", "m/s²", 1, "force"),
    ),
    "COSTS": (
        ("impact_rate_by_frequency", "impacts", "per second", 1),
        ("contact_force_by_frequency", "largest force in a contact", "N", 1),
        ("penetration_by_frequency", "largest penetration of a wall", "mm", 1),
        ("impact_speed_by_frequency", "largest relative speed of an impact", "m/s", 1),
        ("impact_loss_by_frequency", "mean energy lost in an impact", "J", 1),
        ("impact_power_by_frequency", "mean power lost in impacts, which becomes heat", "W", 1),
        ("noise_by_frequency", "noise: sum of the squared impulses, per time", "N² s", 1),
        ("pressure_by_frequency", "largest pressure after Hertz", "MPa", 1e-6),
    ),
    "SPRINGS": (("stiffness", "stiffness", "N/m"), ("damping", "damping", "N s/m")),
    "COUNTS": (
        ("screen_motions", "motions run in the screening"),
        ("screen_orbits", "exact orbits of the screening"),
        ("compared_motions", "motions run to compare gaps"),
    ),
}


def size(value, unit="", digits=3) -> str:
    """Return a size with its unit; "escapes" if infinite, "none found" if unknown."""
    if np.isnan(value):
        return "none found"
    return "escapes" if np.isinf(value) else with_unit(float(value), unit, digits)


def interval(values) -> str:
    """Return a share with its 95 % interval as text; `values` are share, lower and upper end."""
    share, low, high = (percent(float(value)) for value in values)
    return f"{share} ({low} to {high})"


def numbers_of(data) -> dict:
    """Return all numbers of a design, keyed by the names that the templates use."""
    asked = parameters_of(data)
    gap, tolerance = float(data["design_gap"]), asked["tolerances"].get("gap", 0.0)
    limit, edges = float(data["displacement_limit"]), data["cliff_gap"].values
    ends = gap * (1 - tolerance), gap * (1 + tolerance)
    reached = peak(data, "reached_displacement")
    worst = int(np.argmax(data["reached_displacement"].values))
    shares = np.append(data["reached_quiet_share"].values, data["corner_share"].values[:, 0])
    sizes = np.append(data["reached_displacement"].values, data["corner_displacement"].values)
    found = TABLES | {
        "asked": asked,
        "made": json.loads(data.attrs["machine"]),
        "choice": named(data, "design_choice"),
        "promise": named(data, "promise"),
        "gap": gap,
        "restitution": asked["restitution"],
        "limit": limit,
        "share": asked["share"],
        "tolerance": tolerance,
        "ends": ends,
        "narrow": edges[0] > ends[0] or edges[1] < ends[1],
        "quiet_gaps": quiet_gaps(data),
        "critical": float(data["branch_frequency"]),
        "bare": peak(data, "balance_displacement"),
        "bare_count": data.sizes["frequency"],
        "reached": reached,
        "untouched": peak(data, "untouched_displacement"),
        "fewest": float(data["reached_quiet_share"].min()),
        "below_the_limit": bool(((shares < 1) & (sizes <= limit)).any()),
        "short_run": asked["compared_settling"]["limit"] / data["frequency"].values.mean(),
        "yields": _yields(data),
        "peak": lambda name: peak(data, name),
        "at_worst": lambda name: float(data[name].values[worst]),
        "scalar": lambda name: float(data[name]),
    }
    found["advice"] = _advice(found)
    for part in (_tests, _edges, _lives, _orbit, _transients, _rivals, _masses):
        found |= part(data, found)
    found["helpful"], found["tried"] = _helpful(data, found), _tried(data)
    return found


def peak(data, name) -> SimpleNamespace:
    """Return the largest value of a variable over the band, and its frequency; NaN if unknown."""
    values = data[name].values
    if np.isnan(values).all():
        return SimpleNamespace(size=np.nan, frequency=np.nan)
    k = int(np.nanargmax(values))
    return SimpleNamespace(size=float(values[k]), frequency=float(data["frequency"][k]))


def _advice(found):
    """Return in a few words whether to build the damper."""
    choice = found["choice"]
    if found["promise"] == "broken":
        return "Do not build it: the check failed"
    if choice == "robust" and found["promise"] == "nominal_kept":
        return "Build it, and hold all values more closely than your tolerances"
    if choice != "least_worst" and found["reached"].size > found["limit"]:
        return f"{ADVICE[choice]}, and beware: a large motion exists in addition to the quiet one"
    return ADVICE[choice]


def _yields(data):
    """Return whether the contact yields at any frequency."""
    values = data["yields_by_frequency"].values
    known = ("yes", "unknown", "no")
    return next(each for each in known if flag("yields_by_frequency", each) in values)


def _tests(data, found):
    """Return shares of quiet starts: of the choice, of new starts, and of deviating values."""
    row = int(np.argmin(np.abs(data["candidate_gap"].values - found["gap"])))
    shares = data["start_quiet_share"].values[row]
    k = int(np.argmin(shares))
    nearest = SimpleNamespace(
        gap=float(data["candidate_gap"][row]),
        share=[shares[k], *data["start_quiet_interval"].values[row, k]],
        median=float(np.fmax.reduce(data["quiet_time_median"].values[row])),
        late=float(np.fmax.reduce(data["quiet_time_late"].values[row])),
    )
    reached = data["reached_quiet_share"].values
    k = int(np.argmin(reached))
    unseen, sizes = data["corner_share"].values, data["corner_displacement"].values
    samples, corners = data["sample_share"].values, None
    if len(unseen) > 1:
        corners = SimpleNamespace(
            count=len(unseen) - 1,
            share=unseen[1 + np.argmin(unseen[1:, 0])],
            least=float(unseen[1:, 0].min()),
            size=float(sizes.max()),
            beyond=float(sizes[1:].max()),
        )
    return {
        "nearest": nearest,
        "reached_share": [reached[k], *data["reached_quiet_interval"].values[k]],
        "unseen": unseen,
        "unseen_sizes": sizes,
        "corners": corners,
        "samples": SimpleNamespace(
            count=len(samples), share=samples[np.argmin(samples[:, 0])] if len(samples) else None
        ),
    }


def _edges(data, found):
    """Return the ends of the quiet gaps: cliffs, and ends of the comparison."""
    edges = []
    for k, (side, way) in enumerate((("below", "down"), ("above", "up"))):
        gap = float(data["cliff_gap"][k])
        edges.append(
            SimpleNamespace(
                side=side,
                way=way,
                gap=gap,
                distance=abs(gap / found["gap"] - 1),
                frequency=float(data["cliff_frequency"][k]),
                found=int(data["cliff_status"][k]) == flag("cliff_status", "found"),
            )
        )
    return {
        "cliffs": [edge for edge in edges if edge.found],
        "not_ended": [edge for edge in edges if not edge.found],
    }


def _lives(data, found):
    """Return gaps at which chaos passes after some cycles, and gaps at which it lasts."""
    passing, gaps, rates = [], [], []
    if "life_rate" in data:
        for gap, (rate, low, high) in zip(
            data["life_gap"].values, data["life_rate"].values, strict=True
        ):
            if low > 0:
                passing.append(SimpleNamespace(gap=gap, cycles=1 / rate))
            elif np.isfinite(rate):
                gaps.append(number(gap, 4))
                rates.append(high)
    lasting = SimpleNamespace(gaps=", ".join(gaps), cycles=1 / max(rates)) if gaps else None
    return {"passing": passing, "lasting": lasting}


def _orbit(data, found):
    """Return where the quiet orbit is stable, how it depends on values, and the smallest one."""
    ends, event = data["stability_gap"].values, "stability_gap_event"
    stable = ""
    if np.isfinite(ends).all():
        stable = known_range(ends, data[event].values == flag(event, "range_ends"))
    gaps, modulus = data["gap_of_orbit"].values, np.nan
    if len(gaps):
        modulus = float(data["modulus_by_gap"][np.argmin(np.abs(gaps - found["gap"]))])
    size, growth = data["displacement_change"].values, data["modulus_change"].values
    changes = [
        [str(name).replace("_", " "), *(f"{value:.2f} %" for value in each)]
        for name, *each in zip(data["changed"].values, size, growth, strict=True)
        if any(each)
    ]
    return {
        "stable_gaps": stable,
        "modulus": modulus,
        "changes": changes if np.isfinite(size).any() else [],
        "best": SimpleNamespace(
            gap=float(data["best_orbit_gap"]), frequency=float(data["best_orbit_frequency"])
        ),
        "forces": _forces(data, found["critical"]),
    }


def _forces(data, critical):
    """Return the ranges of excitations in which the quiet orbit is stable, or None."""
    ends = data["stability_force_by_frequency"].values
    last = data["force_share"].values[[0, -1]]
    here = ends[np.argmin(np.abs(data["operating_frequency"].values - critical))]
    if np.isnan(here).any():
        return None
    found = SimpleNamespace(here=known_range(here, here == last), over="", narrow=False)
    if np.isfinite(ends).all():
        inner = np.array([ends[:, 0].max(), ends[:, 1].min()])
        found.over = known_range(inner, inner == last)
        found.narrow = bool(min(1 - inner[0], inner[1] - 1) < CLOSE)
    return found


def _transients(data, found):
    """Return largest displacements in sweeps within and outside the band, and decay times.

    The sweeps go through the resonances, which may lie outside the band.
    """
    low, high = found["asked"]["band"]
    swept = []
    for direction in data["direction"].values:
        each = data.sel(direction=direction)
        inside = (each["sweep_frequency"] >= low) & (each["sweep_frequency"] <= high)
        for where, words in ((inside, "through the band"), (~inside, "outside the band")):
            if where.any():
                sizes = each["sweep_envelope"].where(where).max("sweep_window")
                bare, damped = (float(sizes.sel(equipment=name)) for name in ("bare", "damped"))
                swept.append(
                    {"direction": direction, "where": words, "bare": bare, "damped": damped}
                )
    rung = {"first": float(data["ring_envelope"].sel(equipment="bare")[0])}
    for equipment in ("bare", "damped"):
        each = data.sel(equipment=equipment)
        sizes, times = each["ring_envelope"].values, each["ring_time"].values
        below = sizes < DECAY * sizes[0]
        rung[equipment] = float(times[np.argmax(below)]) if below.any() else np.nan
    return {"swept": swept, "rung": rung}


def _rivals(data, found):
    """Return displacements of this damper beside those of the machine alone and the absorber."""
    sizes = data["competitor_displacement"]
    frequency, force = {}, {}
    for name in RIVALS:
        if name == "this":
            frequency[name] = data["reached_displacement"].values
            force[name] = data["force_map_displacement"].values.max(axis=0)
        elif np.isfinite(sizes.sel(competitor=name, detuning=0.0)).any():
            built = sizes.sel(competitor=name, detuning=0.0)
            frequency[name] = built.sel(force_share=1.0).values
            force[name] = built.max("frequency", skipna=False).values
    off = float(sizes.sel(competitor="tuned", force_share=1.0).max(skipna=False))
    worst = {name: float(values.max()) for name, values in frequency.items()}
    best = np.array([*frequency.values()]).argmin(axis=0)
    rows = [
        [
            RIVALS[name],
            size(worst[name], "mm"),
            size(off, "mm") if name == "tuned" else "-",
            *(size(force[name][end], "mm") for end in (0, -1)),
            f"{int((best == k).sum())} of {len(best)} frequencies",
        ]
        for k, name in enumerate(frequency)
    ]
    first, second = (
        SimpleNamespace(key=name, name=RIVALS[name], size=worst[name])
        for name in sorted(worst, key=worst.get)[:2]
    )
    status = int(data["competitor_status"].sel(competitor="bare"))
    approximate = status == flag("competitor_status", "one_harmonic")
    absorber = None
    if np.isfinite(worst.get("tuned", np.nan)):
        absorber = SimpleNamespace(size=worst["tuned"], detuned=off, approximate=approximate)
    return {
        "rivals": rows,
        "first": first,
        "second": second,
        "winners": _winners(data["force_share"].values, force),
        "absorber": absorber,
        "one_harmonic": approximate,
        "tuned": "possible" if "tuned" in frequency else "not_possible",
        "built": lambda name: float(data[f"absorber_{name}"].sel(competitor="tuned", detuning=0.0)),
    }


def _winners(shares, force):
    """Return the best rival in each range of excitations, with the ends of the range."""
    names = list(force)
    best = np.array([*force.values()]).argmin(axis=0)
    found = []
    for winner, group in itertools.groupby(range(len(shares)), key=lambda k: best[k]):
        places = list(group)
        found.append((RIVALS[names[winner]], shares[places[0]], shares[places[-1]]))
    return found


def _masses(data, found):
    """Return the table of other masses, and the lightest that is at least as good as this one."""
    names = ("mass", "gap", "displacement", "share", "force", "best")
    columns = {name: data[f"other_{name}"].values for name in names}
    here = int(np.argmin(np.abs(columns["mass"] - found["asked"]["mass"])))
    rows = []
    for k, (mass, gap, moved, share, force, best) in enumerate(zip(*columns.values(), strict=True)):
        note = " (this one)" * (k == here) + " *" * bool(best)
        texts = [size(gap, "mm"), size(moved, "mm"), percent(share), size(force, "N")]
        rows.append([f"{size(mass, 'kg')}{note}", *texts])
    good = columns["displacement"] <= columns["displacement"][here]
    good &= columns["share"] >= columns["share"][here]
    k = int(np.argmax(good))
    lighter = SimpleNamespace(mass=columns["mass"][k], gap=columns["gap"][k]) if k < here else None
    return {"masses": rows, "lighter": lighter}


def _helpful(data, found):
    """Return what would help if no gap is quiet: other masses, gaps and restitutions."""
    texts, good = [], data["other_share"].values >= found["share"]
    if good.any():
        texts.append(f"a loose mass of {number(data['other_mass'].values[good].min())} kg")
    quiet = np.argwhere(data["damper_map_share"].values >= 1)
    if len(quiet):
        row, column = quiet[-1]
        gap, e = float(data["map_gap"][row]), float(data["map_restitution"][column])
        where = f"at {number(found['critical'], 4)} Hz alone"
        texts.append(f"{where}, a gap of {number(gap)} mm with restitution {number(e, 2)}")
    return texts


def _tried(data):
    """Return the restitutions that were tried, if the user left it free within a range."""
    if "tried_restitution" not in data:
        return None
    values = data["tried_restitution"].values
    *others, last = (number(value) for value in values)
    k = int(np.argmin(np.abs(values - parameters_of(data)["restitution"])))
    end = {0: "lower", len(values) - 1: "upper"}.get(k)
    return SimpleNamespace(others=", ".join(others), last=last, end=end)
