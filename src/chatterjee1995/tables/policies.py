"""Table of rules that say when to switch the damper off: success and cost."""

import pandas as pd

# Columns of the Markdown table with their heads; the CSV file has all columns.
SHOWN = {
    "release_policies": {
        "damper": "damper",
        "W": "forcing frequency Ω",
        "rule": "policy (K in cycles, phase ΩT in radian)",
        "share and interval": "share within 350 cycles (95 % interval)",
        "median and interval": "median time [cycles] (95 % interval)",
        "95 % of cycles": "95 % arrive within [cycles]",
        "median damper on": "median time with damper [cycles]",
        "median impacts": "median number of impacts",
    },
}
# Words for each policy.
POLICIES = {
    "settled": "random phase once settled",
    "hold": "fixed number of cycles",
    "phase": "fixed phase",
    "state": "state in the goal's basin",
}
# Column -> variable of the dataset, without its prefix `case_`.
SYMBOLS = {"rm": "mass_ratio", "d0": "clearance", "e": "restitution"}


def release_policies(datasets) -> pd.DataFrame:
    """Return success, cycles and cost of each policy, by damper and forcing frequency W."""
    rows = []
    for data, case, damper in _cases(datasets):
        for here in (data.isel(case=case, frequency=k) for k in range(data.sizes["frequency"])):
            for policy in here.policy.values:
                one = here.sel(policy=policy)
                median = one.policy_cycles.sel(quantile=0.5)
                rows.append(
                    damper
                    | {"damper": ", ".join(f"{name} = {x:g}" for name, x in damper.items())}
                    | {"W": float(here.frequency), "policy": policy, "rule": _rule(one)}
                    | {"share and interval": _with_interval(one.policy_success)}
                    | {"median and interval": _with_interval(median)}
                    | _bounded("within 350 cycles", one.policy_success)
                    | _bounded("median cycles", median)
                    | _bounded("95 % of cycles", one.policy_cycles.sel(quantile=0.95))
                    | _bounded("median damper on", one.policy_damper)
                    | _bounded("median impacts", one.policy_impacts)
                    | {"releases": float(one.policy_releases), "hold": float(one.policy_hold)}
                    | {"phase": float(one.policy_phase)}
                )
    return pd.DataFrame(rows)


def _cases(datasets):
    """Yield each dataset with the index of each damper and the columns that describe the damper."""
    for data in datasets.get("release_policies", {}).values():
        for case in range(data.sizes["case"]):
            parameters = {
                symbol: float(data[f"case_{name}"][case]) for symbol, name in SYMBOLS.items()
            }
            yield data, case, parameters


def _rule(one):
    """Return the policy in words, with the parameters that were chosen for it."""
    words, cycles = POLICIES[str(one.policy.values)], f"K = {float(one.policy_hold):g}"
    return {
        "hold": f"{words}, {cycles}",
        "phase": f"{words} {float(one.policy_phase):.2f} after {cycles}",
        "state": f"{words}, at most {cycles}",
    }.get(str(one.policy.values), words)


def _with_interval(value):
    """Return the text of a share or quantile and its confidence interval."""
    middle, lower, upper = (
        f"{float(value.sel(bound=bound)):.3g}".replace("inf", "∞")
        for bound in ("share", "lower", "upper")
    )
    return middle if middle == lower == upper else f"{middle} ({lower} to {upper})"


def _bounded(words, value):
    """Return columns with a share or quantile and the ends of its confidence interval."""
    names = {"share": words, "lower": f"{words}, at least", "upper": f"{words}, at most"}
    return {name: float(value.sel(bound=bound)) for bound, name in names.items()}
