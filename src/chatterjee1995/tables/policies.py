"""Tables of policies of migration: success and cost, test of the release set, and disturbances.

Migration takes the oscillator from its resonance to its small motion, the goal: the damper is
switched on, and off at a well-chosen moment (the release). A policy chooses this moment. The
release set holds the states from which a release leads to the goal. The policy by state releases in
this set, at least a margin away from its boundary.
"""

import numpy as np
import pandas as pd

from chatterjee1995.stages.best_dampers import best_clearances

# Columns of the Markdown tables with their heads; the CSV files have all columns. First the columns
# that several tables share.
DAMPER = {
    "rm": "mass ratio rm",
    "d0": "clearance d0",
    "e": "restitution e",
    "W": "forcing frequency Ω",
}
SHOWN = {
    "release_policies": {
        "damper": "damper",
        "W": DAMPER["W"],
        "rule": "policy (K in cycles, phase ΩT in radian)",
        "share and interval": "share within 350 cycles (95 % interval)",
        "median and interval": "median time [cycles] (95 % interval)",
        "95 % of cycles": "95 % arrive within [cycles]",
        "median damper on": "median time with damper [cycles]",
        "median impacts": "median number of impacts",
    },
    "release_predictions": DAMPER
    | {
        "predicted": "share of releases predicted to reach the goal",
        "realised": "share of releases that reach it",
        "within 1 %": "do both shares agree within 0.01",
        "state over settled": "median time by state / median time by random phase (empty if fewer "
        "than half of the runs by random phase arrive)",
        "at most half": "is this ratio at most 1/2",
    },
    "release_disturbances": DAMPER
    | {
        "disturbance": "disturbance",
        "without margin": "share within 350 cycles without margin",
        "best margin": "best margin / size of the resonance motion",
        "with best margin": "share with the best margin",
        "median cycles": "median time with the best margin [cycles]",
    },
    "release_dampers": {
        "W": DAMPER["W"],
        "e": DAMPER["e"],
        "rm": DAMPER["rm"],
        "d0 for migration": "best clearance for migration by state",
        "median cycles": "median time with the clearance for migration [cycles]",
        "d0 for suppression": "best clearance for suppression",
        "quiet": "quiet displacement with the clearance for suppression / free resonance",
        "median cycles, suppression": "median time with the clearance for suppression [cycles]",
        "same": "is the clearance for suppression as good for migration, within the 95 % intervals "
        "of the medians",
    },
    "release_answers": {
        "W": DAMPER["W"],
        "e": DAMPER["e"],
        "for migration": "best damper for migration by state",
        "median cycles": "median time with the damper for migration [cycles]",
        "quiet": "quiet displacement with the damper for migration / free resonance",
        "for suppression": "best damper for suppression",
        "median cycles, suppression": "median time with the damper for suppression [cycles]",
        "quiet, suppression": "quiet displacement with the damper for suppression / free resonance",
        "answer": "is one damper the best for both",
    },
}
# Words for each policy.
POLICIES = {
    "settled": "random phase once settled",
    "hold": "fixed number of cycles",
    "phase": "fixed phase",
    "state": "state in the goal's basin",
    "clairvoyant": "future known",
}
# Column -> variable of the dataset, without its prefix `case_`.
SYMBOLS = {"rm": "mass_ratio", "d0": "clearance", "e": "restitution"}


def release_policies(datasets) -> pd.DataFrame:
    """Return success, cycles and cost of each policy, by damper and forcing frequency W.

    The policy "clairvoyant" knows the future and therefore bounds the success of all others.
    """
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
                    | {"least impulse without damper": float(here.least_impulse)}
                )
    return pd.DataFrame(rows)


def release_predictions(datasets) -> pd.DataFrame:
    """Return for each damper and W how well the release set predicts where releases lead.

    A further column says whether the policy by state takes at most half of the time of the paper's
    policy, which releases at a random phase once the motion has settled. It says "not known" if
    fewer than half of the trials by state reach the goal.
    """
    rows = []
    for data, case, damper in _cases(datasets):
        for here in (data.isel(case=case, frequency=k) for k in range(data.sizes["frequency"])):
            shares = here[["predicted_share", "realised_share", "agreeing_share"]].sel(
                bound="share"
            )
            predicted, realised = float(shares.predicted_share), float(shares.realised_share)
            median = here.policy_cycles.sel(quantile=0.5, bound="share")
            state, settled = (float(median.sel(policy=name)) for name in ("state", "settled"))
            known, ratio = np.isfinite(state), state / settled if np.isfinite(settled) else np.nan
            rows.append(
                damper
                | {
                    "W": float(here.frequency),
                    "predicted": predicted,
                    **_bounded("realised", here.realised_share),
                    "right for": float(shares.agreeing_share),
                    "within 1 %": _yes(abs(predicted - realised) <= 0.01),
                    "median by state": state,
                    "median by random phase": settled,
                    "state over settled": ratio,
                    # trials end after 350 cycles, so an infinite median is at least that long
                    "at most half": _yes(state <= min(settled, 350) / 2) if known else "not known",
                }
            )
    return pd.DataFrame(rows)


def release_disturbances(datasets) -> pd.DataFrame:
    """Return the success of the policy by state under disturbances, for each margin.

    Margins are divided by the size of the resonance motion. The columns `margin ...` hold success
    and median of the cycles with each margin.
    """
    rows = []
    for data, case, damper in _cases(datasets):
        for frequency in data.noisy_frequency.values:
            here = data.isel(case=case).sel(noisy_frequency=frequency)
            bound = here.policy_success.sel(policy="clairvoyant", frequency=frequency)
            for disturbance in here.disturbance.values:
                one = here.sel(disturbance=disturbance)
                best = best_margin(one)
                margins = {}
                for margin in one.margin.values:
                    at, words = one.sel(margin=margin), f"margin {margin:g}"
                    margins |= _bounded(words, at.disturbed_success)
                    margins |= _bounded(f"{words}, median cycles", at.disturbed_cycles)
                rows.append(
                    damper
                    | {"W": float(frequency), "disturbance": disturbance}
                    | _bounded("without margin", one.disturbed_success.sel(margin=0))
                    | {"best margin": best}
                    | _bounded("with best margin", one.disturbed_success.sel(margin=best))
                    | _bounded("median cycles", one.disturbed_cycles.sel(margin=best))
                    | {"clairvoyant": float(bound.sel(bound="share"))}
                    | margins
                )
    return pd.DataFrame(rows)


def release_dampers(datasets) -> pd.DataFrame:
    """Return the best clearances for migration and suppression, by frequency, e and mass ratio.

    Suppression means a small motion with the damper left on. The best clearance for suppression
    counts as equally good for migration if the confidence intervals of the median numbers of cycles
    overlap.
    """
    rows = []
    for data in datasets.get("release_dampers", {}).values():
        for frequency, restitution in np.ndindex(
            data.sizes["frequency"], data.sizes["restitution"]
        ):
            one = data.isel(frequency=frequency, restitution=restitution)
            best = best_clearances(one)
            ratio = one.damper_quiet / one.resonance_displacement
            cycles = one.damper_cycles.sel(policy="state")
            success = one.damper_success.sel(policy="state", bound="share")
            for k, mass_ratio in enumerate(one.mass_ratio.values):
                row = {"W": float(one.frequency), "e": float(one.restitution), "rm": mass_ratio}
                gaps = {name: best[name][k] for name in ("migration", "suppression")}
                row |= {f"d0 for {name}": gap for name, gap in gaps.items()}
                if np.isfinite([*gaps.values()]).all():
                    here, quiet = (
                        cycles.sel(mass_ratio=mass_ratio, clearance=gap) for gap in gaps.values()
                    )
                    row |= _bounded("median cycles", here)
                    row |= _bounded("median cycles, suppression", quiet)
                    at = {"mass_ratio": mass_ratio, "clearance": gaps["suppression"]}
                    row |= {"quiet": float(ratio.sel(at))}
                    row |= {"share, suppression": float(success.sel(at))}
                    overlap = float(quiet.sel(bound="lower")) <= float(here.sel(bound="upper"))
                    found = np.isfinite(quiet.sel(bound="share"))
                    row |= {"same": _yes(len({*gaps.values()}) == 1 or (overlap and found))}
                rows.append(row)
    return pd.DataFrame(rows)


def release_answers(datasets) -> pd.DataFrame:
    """Return the best damper of the map for each purpose, by frequency and restitution."""
    rows = []
    for data in datasets.get("release_dampers", {}).values():
        for frequency, restitution in np.ndindex(
            data.sizes["frequency"], data.sizes["restitution"]
        ):
            one = data.isel(frequency=frequency, restitution=restitution)
            state = one.sel(policy="state").stack(damper=("mass_ratio", "clearance"))
            quiet = state.damper_quiet / state.resonance_displacement
            row = {"W": float(one.frequency), "e": float(one.restitution)}
            success, cycles = (
                state[f"damper_{name}"].sel(bound="share").values for name in ("success", "cycles")
            )
            best = int(np.lexsort((cycles, -success))[0])
            if np.isfinite(cycles[best]) and np.isfinite(quiet).any():
                quietest = int(np.nanargmin(quiet.values))
                for words, k in (("", best), (", suppression", quietest)):
                    row |= {f"median cycles{words}": cycles[k], f"quiet{words}": float(quiet[k])}
                for purpose, k in (("migration", best), ("suppression", quietest)):
                    rm, d0 = state.damper.values[k]
                    row |= {f"for {purpose}": f"rm = {rm:g}, d0 = {d0:g}"}
                ends = state.damper_cycles
                apart = float(ends.sel(bound="lower")[quietest]) > float(
                    ends.sel(bound="upper")[best]
                )
                slower = (
                    "no; the damper for suppression is slower"
                    if apart
                    else "no, but the damper for suppression is as fast within the error"
                )
                row |= {"answer": "yes" if best == quietest else slower}
            else:
                row |= {"answer": "no damper reaches the goal in half of the runs, or is quiet"}
            rows.append(row)
    return pd.DataFrame(rows)


def best_margin(one):
    """Return the margin with the largest success; among equals, the margin with the least time."""
    success, cycles = (
        one[name].sel(bound="share").values for name in ("disturbed_success", "disturbed_cycles")
    )
    return float(one.margin.values[np.lexsort((cycles, -success))[0]])


def _cases(datasets):
    """Yield each dataset with the index of each damper and the columns that describe the damper."""
    for data in datasets.get("release_policies", {}).values():
        for case in range(data.sizes["case"]):
            parameters = {
                symbol: float(data[f"case_{name}"][case]) for symbol, name in SYMBOLS.items()
            }
            yield data, case, parameters


def _rule(one):
    """Return the policy in words, with the parameters that were chosen for it.

    The trials that compare policies release by state without a margin.
    """
    words, cycles = POLICIES[str(one.policy.values)], f"K = {float(one.policy_hold):g}"
    return {
        "hold": f"{words}, {cycles}",
        "phase": f"{words} {float(one.policy_phase):.2f} after {cycles}",
        "state": f"{words}, margin 0, at most {cycles}",
    }.get(str(one.policy.values), words)


def _with_interval(value):
    """Return the text of a share or quantile and its confidence interval."""
    middle, lower, upper = (
        f"{float(value.sel(bound=bound)):.3g}".replace("inf", "∞")
        for bound in ("share", "lower", "upper")
    )
    return middle if middle == lower == upper else f"{middle} ({lower} to {upper})"


def _yes(holds):
    """Return "yes" or "no"."""
    return "yes" if holds else "no"


def _bounded(words, value):
    """Return columns with a share or quantile and the ends of its confidence interval."""
    names = {"share": words, "lower": f"{words}, at least", "upper": f"{words}, at most"}
    return {name: float(value.sel(bound=bound)) for bound, name in names.items()}
