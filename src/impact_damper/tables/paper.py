"""Tables of the results: designs, bands, optima, subharmonics, migration and releases."""

import numpy as np
import pandas as pd

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Missing
from impact_damper.claims.suppression import chaotic_high, high_motions, suppression_band
from impact_damper.data.datasets import flag, is_settled

PARAMETERS = {
    "damping": "h",
    "linear_frequency": "omega_l",
    "mass_ratio": "rm",
    "clearance": "d0",
    "restitution": "e",
    "frequency": "W",
}


def parameters_by_symbol(data, *names):
    """Columns of the parameters that made a dataset, by the paper's symbols."""
    return {PARAMETERS[name]: extract.parameter(data, name) for name in names}


def design(datasets) -> pd.DataFrame:
    """What rule (19) and harmonic balance give for each curve at its peak frequency."""
    rows = []
    for name, data in datasets.get("design", {}).items():
        peak = float(data.peak_frequency)
        given = parameters_by_symbol(data, "damping", "linear_frequency", "mass_ratio", "clearance")
        inertia = given["rm"] * peak**2
        rows.append(
            {"curve": name}
            | given
            | {
                "Wp": peak,
                "free |a| at Wp": float(data.peak_amplitude),
                "d0 of (19)": 1 / inertia,
                "rm Wp^2 d0": inertia * given["d0"],
                "|a| at Wp": float(data.quiet_amplitude),
                "reduction at Wp": float(data.reduction),
            }
            | _true_orbit(datasets.get("design_orbit", {}).get(name))
        )
    return pd.DataFrame(rows)


def _true_orbit(orbit):
    """The exact quiet orbit at the design point, and what starts come to there."""
    if orbit is None:
        return {}
    runs = {
        "starts that settle": float(np.mean(is_settled({"outcome": orbit.design_run_outcome}))),
        "largest max |Z1| of starts": float(orbit.design_run_displacement.max()),
    }
    try:
        at = extract.design_point(orbit)
    except Missing:
        return {"quiet orbit": "not found"} | runs
    size = float(extract.largest_multiplier(at))
    return {
        "quiet orbit": "stable" if size < 1 else "unstable",
        "its max |Z1|": float(at.orbit_displacement),
        "largest multiplier": size,
        "stable from h": extract.stable_from(orbit),
    } | runs


def bands(datasets) -> pd.DataFrame:
    """Suppression bands by harmonic balance and by the motions that exist, and where chaos is."""
    designs, responses = datasets.get("design", {}), datasets.get("response", {})
    rows = []
    for name in dict.fromkeys([*designs, *responses]):
        row = {"curve": name} | parameters_by_symbol(
            designs.get(name, responses.get(name)),
            "damping",
            "linear_frequency",
            "mass_ratio",
            "clearance",
            "restitution",
        )
        if name in designs:
            row |= _balance_band(designs[name])
        if name in responses:
            row |= _existing_band(datasets, name)
        rows.append(row)
    return pd.DataFrame(rows)


def _balance_band(data):
    events = [extract.meaning("edge_event", value) for value in data.edge_event.values]
    return {
        "lower, balance": float(data.edge_frequency[0]),
        "ended by": events[0],
        "upper, balance": float(data.edge_frequency[1]),
        "ended above by": events[1],
        "width, balance": float(data.band_width),
        "least reduction": float(data.edge_reduction.min()),
        "no better than free from W": float(data.break_even_frequency),
    }


def _existing_band(datasets, name):
    response = datasets["response"][name]
    try:
        free = exact.free_of(datasets, response)
        band = suppression_band(datasets, name)
    except Missing:
        return {}
    motions = extract.touching(response).sum("motion")
    inside = response.frequency.values[
        (response.frequency > band.lower + band.resolution) & (response.frequency <= band.upper)
    ]
    chaotic = chaotic_high(response, free).values
    frequency, step = response.frequency.values, extract.spacing(response)
    starts = response.sizes["start"]
    high = high_motions(response, free) & extract.is_outcome(response, "chaotic")
    share = response.share.where(high, 0).sum("motion").values[chaotic] / starts
    return {
        "lower, motions": band.lower,
        "or up to": band.lower + band.resolution,
        "upper, motions": band.upper,
        "width, motions": band.width,
        "share of it with a single motion": float((motions.sel(frequency=inside) == 1).mean())
        if len(inside)
        else np.nan,
        "high chaos from W": frequency[chaotic].min() if chaotic.any() else np.nan,
        "to W": frequency[chaotic].max() if chaotic.any() else np.nan,
        "width of high chaos": chaotic.sum() * step,
        "widest range of it": extract.longest_run(chaotic) * step,
        "share of starts there": np.mean(share) if chaotic.any() else np.nan,
    }


def optima(datasets) -> pd.DataFrame:
    """Optimum clearances by simulation against (7) and rule (19), and what explains the excess."""
    rows = []
    for name, data in datasets.get("optimum", {}).items():
        best, rule = float(data.optimum_clearance), float(data.rule_clearance)
        lower, upper = data.near_clearance.values
        rows.append(
            {"sweep": name}
            | parameters_by_symbol(data, "damping", "frequency", "mass_ratio", "restitution")
            | {
                "d0 of (18) at W": rule,
                "d0 of (19) at Wp": float(data.peak_rule_clearance),
                "optimum d0 of (7)": float(data.analytical_optimum),
                "optimum d0": best,
                "least max |Z1|": float(data.optimum_displacement),
                "kind": extract.meaning("optimum_kind", data.optimum_kind),
                "within 10 % from d0": lower,
                "to d0": upper,
                "excess over (18)": best / rule - 1,
                "rm W^2 d0": float(data.optimum_ratio),
                "rm W^2 d0 of straight flight": float(data.straight_flight_ratio),
            }
        )
    return pd.DataFrame(rows)


def subharmonics(datasets) -> pd.DataFrame:
    """Where the one-third subharmonic is stable without the damper, and each branch of it with."""
    rows = [
        {"data": name, "damper": "off"}
        | parameters_by_symbol(free, "damping", "linear_frequency")
        | _free_subharmonic(free)
        for name, free in datasets.get("free_branches", {}).items()
    ]
    for name, curve in datasets.get("subharmonic", {}).items():
        given = parameters_by_symbol(
            curve, "damping", "linear_frequency", "mass_ratio", "clearance"
        )
        shared = curve.where(curve.free_subharmonic.notnull())
        runs = shared.switched_share.sel(switched_motion="subharmonic")
        summary = {"data": name, "damper": "on"} | given
        rows.append(
            summary
            | {
                "branch": "all",
                "largest max |Z1|": float(shared.damped_subharmonic.max()),
                "over that without damper": float(shared.subharmonic_ratio.max()),
                "share of runs from the free one": float(runs.mean()),
            }
        )
        if name in datasets.get("branches", {}):
            part = exact.stable_subharmonics(datasets["branches"][name])
            rows += [summary | _stable_part(branch) for _, branch in part.groupby("branch")]
    return pd.DataFrame(rows)


def _stable_part(part):
    """Number and period of a branch of subharmonics, and where it is stable."""
    return {
        "branch": f"{part.branch.iloc[0] + 1}",
        "period": part.period.iloc[0],
        "from W": part.lower.min(),
        "to W": part.upper.max(),
        "largest max |Z1|": part["size"].max(),
    }


def _free_subharmonic(free):
    """The free subharmonic of a dataset of branches."""
    try:
        part = exact.subharmonic(free)
    except Missing:
        return {"branch": "none"}
    return _stable_part(part[part.stable])


def migration(datasets) -> pd.DataFrame:
    """Where releases of each damped motion lead, and how the runs of the controller end."""
    rows = []
    for name, case in datasets.get("migration", {}).items():
        reached = case.trial_outcome == flag("trial_outcome", "reached")
        runs = {
            "runs that arrive": float(reached.mean()),
            "within 350 cycles": float(case.within_share.sel(bound="share")),
            "median switchings of those": float(case.switchings.where(reached).median()),
            "median cycles, damper on, all runs": float(case.damper_time.median()),
            "median cycles, all runs": float(case.total_time.median()),
            "most cycles, all runs": float(case.total_time.max()),
            "watched runs that land on the quiet motion": float(
                (case.landed_on == flag("landed_on", "quiet")).mean()
            ),
            "captures per cycle by any settled motion": float(case.escape_rate.sel(bound="share")),
        }
        for k in range(case.sizes["damped"]):
            shares = case.release_share.isel(damped=k)
            rows.append(
                {"case": name}
                | parameters_by_symbol(case, "frequency")
                | {
                    "released from": extract.meaning("damped_kind", case.damped_kind[k]),
                    "period": int(case.damped_period[k]),
                    "max |Z1|": float(case.damped_displacement[k]),
                }
                | {
                    f"to {end}".replace("_", "-"): float(shares.sel(free_motion=end, bound="share"))
                    for end in case.free_motion.values
                }
                | {
                    "to non-resonance at least": float(
                        shares.sel(free_motion="non_resonance", bound="lower")
                    ),
                    "at most": float(shares.sel(free_motion="non_resonance", bound="upper")),
                }
                | runs
            )
    return pd.DataFrame(rows)


def releases(datasets) -> pd.DataFrame:
    """At which frequencies releases of each kind of damped motion lead to which free motions."""
    rows = []
    for name, scan in datasets.get("release_scan", {}).items():
        shares = scan.release_share.sel(bound="share", drop=True).to_series().unstack().dropna()
        shares["kind"] = scan.damped_kind.to_series()
        shares["period"] = scan.damped_period.to_series()
        shares = shares.groupby(["kind", "period", "frequency"])[list(scan.free_motion.values)]
        for (kind, period), motion in shares.mean().groupby(level=["kind", "period"]):
            motion = motion.droplevel(["kind", "period"])
            ends = motion.apply(lambda row: ", ".join(row.index[row > 0]), axis=1)
            for led, part in motion.groupby(ends, sort=False):
                rows.append(
                    {"scan": name}
                    | parameters_by_symbol(
                        scan, "damping", "mass_ratio", "clearance", "restitution"
                    )
                    | {
                        "released from": extract.meaning("damped_kind", kind),
                        "period": int(period),
                        "leads to": led.replace("_", "-"),
                        "at W": _ranges(scan.frequency.values, part.index),
                        "frequencies": len(part),
                    }
                    | {f"to {end}".replace("_", "-"): part[end].mean() for end in part}
                )
    return pd.DataFrame(rows)


def _ranges(grid, chosen):
    """Chosen values of a grid in words, those that are neighbours as a range."""
    there = np.isin(grid, chosen).astype(int)
    edges = np.flatnonzero(np.diff(there, prepend=0, append=0)).reshape(-1, 2)
    ends = [dict.fromkeys([f"{grid[first]:.5g}", f"{grid[last - 1]:.5g}"]) for first, last in edges]
    return ", ".join(" to ".join(pair) for pair in ends)
