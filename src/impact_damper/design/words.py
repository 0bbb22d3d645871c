"""The conclusion of a design in sentences, each number from its datasets."""

import numpy as np

from impact_damper.data.datasets import flag

SUMMARY = {
    "robust": (
        "Build a gap of {gap:.3g} mm (full play). Over the band, and with gaps from {low:.3g} to "
        "{high:.3g} mm, at least {share:.0%} of the starts end quiet, at 95 % confidence: the "
        "machine then moves at most {limit:.3g} mm, instead of {bare:.3g} mm without the damper."
    ),
    "needs_tolerance": (
        "Build a gap of {gap:.3g} mm (full play) and hold it from {edge_low:.4g} to "
        "{edge_high:.4g} mm, a narrower range than the tolerance of {tolerance:.0%}. Then at least "
        "{share:.0%} of the starts end quiet at each frequency of the band, at 95 % confidence: "
        "the machine moves at most {limit:.3g} mm, instead of {bare:.3g} mm without the damper."
    ),
    "least_worst": (
        "No gap is quiet over the whole band. The gap of {gap:.3g} mm is the least bad: the "
        "machine moves up to {worst:.3g} mm, instead of {bare:.3g} mm without the damper. Do not "
        "build this damper for this band."
    ),
}


def conclusion(task, kind, data) -> list[str]:
    """Return the conclusion as sentences.

    Parameters
    ----------
    task : Task
    kind : str
        Of `choose.Choice`.
    data : xarray.Dataset
        Of `stages.machines.design_damper`, but for the conclusion.
    """
    gap = float(data["design_gap"])
    tolerance = task.tolerances.get("gap", 0.0)
    edges = data["cliff_gap"].values
    numbers = {
        "gap": gap,
        "low": gap * (1 - tolerance),
        "high": gap * (1 + tolerance),
        "tolerance": tolerance,
        "edge_low": edges[0],
        "edge_high": edges[1],
        "share": task.share,
        "limit": float(data["displacement_limit"]),
        "bare": float(data["balance_displacement"].max()),
        "worst": float(data["reached_displacement"].max()),
    }
    found = [SUMMARY[kind].format(**numbers), _sureness(task, data)]
    if kind == "least_worst":
        found.append(_help(task, data))
    else:
        found += [_margins(data, gap), _lives(data), _amplitudes(data)]
    found.append(_competition(data))
    return [sentence for sentence in found if sentence]


def _sureness(task, data):
    """Return what unseen starts did."""
    share, worst = data["corner_share"].values, data["corner_displacement"]
    corners = len(share) - 1
    text = (
        f"Checked by starts that the design had not seen: {share[0, 0]:.1%} of them end quiet at "
        f"the nominal values (95 % interval {share[0, 1]:.1%} to {share[0, 2]:.1%})"
    )
    if corners:
        text += (
            f", and at least {share[1:, 0].min():.1%} at each of {corners} corners of the "
            f"tolerances; the largest displacement of any of them was {float(worst.max()):.3g} mm"
        )
    return text + "."


def _margins(data, gap):
    """Return the distances to the basin cliff and to the end of stability."""
    texts = []
    for k, side in enumerate(("below", "above")):
        edge = float(data["cliff_gap"][k])
        if int(data["cliff_status"][k]) == flag("cliff_status", "found"):
            texts.append(
                f"{abs(edge / gap - 1):.1%} {side} (at {float(data['cliff_frequency'][k]):.4g} Hz)"
            )
    text = ""
    if texts:
        text = f"Quiet starts become fewer {' and '.join(texts)}."
    else:
        text = "Within the gaps compared, quiet starts do not become fewer."
    limits = data["stability_gap"].values
    if np.isfinite(limits).any():
        text += (
            f" The quiet orbit at {float(data['branch_frequency']):.4g} Hz is stable from "
            f"{limits[0]:.4g} to {limits[1]:.4g} mm: not this range but the share of starts "
            "decides."
        )
    return text


def _lives(data):
    """Return where chaos beside the quiet motion changes from a transient to an attractor."""
    if "life_rate" not in data:
        return ""
    gaps = data["life_gap"].values
    rates, least, most = data["life_rate"].values.T
    texts = []
    for gap, rate, low, high in zip(gaps, rates, least, most, strict=True):
        if not np.isfinite(rate):
            continue  # all starts were quiet before lives are counted
        life = f"{1 / rate:.0f} periods" if low > 0 else f"more than {1 / high:.0f} periods"
        texts.append(f"{life} at {gap:.4g} mm")
    if not texts:
        return ""
    return f"Beside the quiet motion other motions last, on average, {', '.join(texts)}."


def _amplitudes(data):
    """Return the forces between which the quiet orbit is stable."""
    least, most = data["stability_force"].values
    if not np.isfinite(least):
        return ""
    return f"The quiet orbit is stable from {least:.3g} to {most:.3g} times the nominal force."


def _help(task, data):
    """Return what would help where no gap is quiet."""
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
            "No mass up to twice this one, and no gap and restitution tried, makes starts end "
            "quiet over the band."
        )
    return f"What would help: {'; or '.join(texts)}."


def _competition(data):
    """Return how far the machine would move with the best tuned absorber of the same mass."""
    sizes = data["competitor_displacement"].sel(detuning=0.0, force_share=1.0).max("frequency")
    texts = [
        f"{float(sizes.sel(competitor=name)):.3g} mm with a {name} absorber"
        for name in ("tuned", "nonlinear")
        if np.isfinite(float(sizes.sel(competitor=name)))
    ]
    if not texts:
        return "A tuned absorber is not possible for this machine."
    return f"With the same mass the machine would move {' or '.join(texts)}."
