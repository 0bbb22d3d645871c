"""Tables of migration. A release switches the damper off; a release policy says when."""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading.datasets import POLICIES
from chatterjee1995.tables.files import DAMPER, parameter_columns
from impact_damper.data.datasets import flag
from impact_damper.data.motion_variables import DAMPED_MOTION
from impact_damper.data.sweeps import runs_of_true

KINDS = {number: kind for kind, number in DAMPED_MOTION.items()}


def migration(datasets) -> pd.DataFrame:
    """Return a table: the share of releases to each free motion, and how long migration takes."""
    rows = []
    for name, case in datasets.get("migration", {}).items():
        reached = case.trial_outcome == flag("trial_outcome", "reached")
        runs = {
            "share of control runs within 350 cycles": float(case.within_share.sel(bound="share")),
            "median time [cycles]": float(case.total_time.median()),
            "longest time [cycles]": float(case.total_time.max()),
            "median time with damper [cycles]": float(case.damper_time.median()),
            "runs that arrive": float(reached.mean()),
            "median switchings of runs that arrive": float(case.switchings.where(reached).median()),
        }
        for k in range(case.sizes["damped"]):
            kind = reading.meaning(case.damped_kind[k])
            shares = case.release_share.isel(damped=k)
            rows.append(
                {"case": name}
                | parameter_columns(case, "frequency")
                | {
                    "released from": kind
                    + (", without contact" if case.damped_contacts[k] == 0 else "")
                }
                | {
                    _destination(end): float(shares.sel(free_motion=end, bound="share"))
                    for end in ("non_resonance", "resonance", "subharmonic", "unresolved")
                }
                | runs
                | {
                    "period": int(case.damped_period[k]),
                    "displacement max |Z1|": float(case.damped_displacement[k]),
                    _destination("other"): float(shares.sel(free_motion="other", bound="share")),
                }
            )
    return pd.DataFrame(rows)


def _destination(motion):
    if motion in ("unresolved", "other"):
        return f"share {motion}"
    return f"share to the {motion.replace('_', '-')}"


def release_scan(datasets) -> pd.DataFrame:
    """Return a table: to which free motions releases lead, and at which forcing frequencies."""
    rows = []
    for name, scan in datasets.get("release_scan", {}).items():
        ends = list(scan.free_motion.values)
        shares = scan.release_share.sel(bound="share", drop=True).to_series().unstack().dropna()
        shares["kind"] = scan.damped_kind.to_series()
        shares["period"] = scan.damped_period.to_series()
        means = shares.groupby(["kind", "period", "frequency"])[ends].mean()
        for (kind, period), motion in means.groupby(level=["kind", "period"]):
            motion = motion.droplevel(["kind", "period"])
            led = motion.apply(lambda row: ", ".join(row.index[row > 0]), axis=1)
            for destinations, part in motion.groupby(led, sort=False):
                rows.append(
                    {
                        "scan": name,
                        "released from": KINDS[kind],
                        "period of the damped motion [cycles]": int(period),
                        "leads to": destinations.replace("_", "-"),
                        "at Ω": _ranges(scan.frequency.values, part.index),
                        "frequencies": len(part),
                    }
                    | {
                        _destination(end): part[end].mean()
                        for end in ("non_resonance", "resonance", "subharmonic", "unresolved")
                    }
                    | {_destination("other"): part["other"].mean()}
                    | parameter_columns(scan, "damping", *DAMPER)
                )
    return pd.DataFrame(rows)


def _ranges(grid, chosen):
    """Return chosen values of a grid as text. Neighbouring values are joined: "1.7 to 1.9, 2.1"."""
    runs = runs_of_true(np.isin(grid, chosen))
    ends = [dict.fromkeys([f"{grid[first]:.5g}", f"{grid[last - 1]:.5g}"]) for first, last in runs]
    return ", ".join(" to ".join(pair) for pair in ends)


def release_policies(datasets) -> pd.DataFrame:
    """Return a table of release policies: how often and how fast each one succeeds."""
    rows = []
    for data in datasets.get("release_policies", {}).values():
        dims = ("case", "frequency", "policy")
        for place in np.ndindex(*(data.sizes[dim] for dim in dims)):
            one = data.isel(dict(zip(dims, place, strict=True)))
            rm, d0, e = (float(one[f"case_{name}"]) for name in DAMPER)
            median, most = (one.policy_cycles.sel(quantile=share) for share in (0.5, 0.95))
            rows.append(
                {
                    "damper": f"rm = {rm:g}, d0 = {d0:g}, e = {e:g}",
                    "forcing frequency Ω": float(one.frequency),
                    "policy (K in cycles, phase ΩT in radian)": _rule(one),
                    "share within 350 cycles (95 % interval)": _with_interval(one.policy_success),
                    "median time [cycles] (95 % interval)": _with_interval(median),
                    "95 % arrive within [cycles]": float(most.sel(bound="share")),
                    "median time with damper [cycles]": float(one.policy_damper),
                    "median number of impacts": float(one.policy_impacts),
                    "mean number of releases": float(one.policy_releases),
                }
            )
    return pd.DataFrame(rows)


def _rule(one):
    words, cycles = POLICIES[str(one.policy.values)], f"K = {float(one.policy_hold):g}"
    return {
        "hold": f"{words}, {cycles}",
        "phase": f"{words} {float(one.policy_phase):.2f} after {cycles}",
        "state": f"{words}, at most {cycles}",
    }.get(str(one.policy.values), words)


def _with_interval(value):
    middle, lower, upper = (
        f"{float(value.sel(bound=bound)):.3g}".replace("inf", "∞")
        for bound in ("share", "lower", "upper")
    )
    return middle if middle == lower == upper else f"{middle} ({lower} to {upper})"
