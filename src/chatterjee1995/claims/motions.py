"""Evidence for claims 5 to 8 and 15, on contacts, chaos and phases of the motions with damper."""

import math

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.bands import high_motions
from chatterjee1995.reading.datasets import BY_MASS, ELASTIC, INELASTIC, Missing
from impact_damper.data.sweeps import runs_of_true
from impact_damper.theory.contact_law import damping_ratio

NEAR = 0.3  # phase in radians up to which two motions are almost in phase, or almost in antiphase
LOW = 0.3  # example of a low restitution in claim 15


def quiet_contacts(datasets):
    """Return the numbers of claim 5: the quiet motion has two symmetric impacts in a cycle."""
    shares, skew, multipliers = [], [], []
    for name in ELASTIC:
        lower, upper = reading.band_edges(reading.get(datasets, "harmonic_balance", name))
        quiet = orbits.quiet(*orbits.of_curve(datasets, name))
        in_band = quiet[(quiet.upper > lower) & (quiet.lower < upper)]
        others = in_band[(in_band.fewest != 2) | (in_band.contacts != 2)]
        width = orbits.covered(in_band, lower, upper) - orbits.covered(others, lower, upper)
        shares.append(width / (upper - lower))
        skew.append(in_band.asymmetry.max())
        multipliers.append(in_band.multiplier.max())
    return {"two": np.min(shares), "skew": np.max(skew), "multiplier": np.max(multipliers)}


def high_and_chaotic(datasets):
    """Return the numbers of claim 6: a violent motion has more than two impacts, or is chaotic."""
    of = pd.DataFrame([_violent(datasets, name) for name in ELASTIC], index=ELASTIC)
    contacts, lives = (np.concatenate(of[name].tolist()) for name in ("contacts", "lives"))
    compared, twins = (pd.concat(of[name].tolist()) for name in ("compared", "twins"))
    if len(contacts) == 0 or not compared.a.notna().any():
        raise Missing(
            "There is no violent motion, or no stable violent orbit at a W at which (7) has a "
            "stable violent solution"
        )
    return {
        "more": np.mean(contacts > 2 + 1e-6),
        "fewest": of.fewest.min(),
        "fewest_in": of.fewest.idxmin(),
        "harmonic": np.abs(compared.a / compared.amplitude.abs() - 1).median(),
        "size": np.abs(compared.a / compared["size"] - 1).median(),
        "coexisting": of.coexisting.max(),
        "coexisting_in": of.coexisting.idxmax(),
        "twin": twins.difference.median(),
        "widest": of.widest.max(),
        "widest_in": of.widest.idxmax(),
        "widest_first": of.widest.iloc[0],
        "total": of.total.max(),
        "starts": of.starts.max(),
        "lasting": np.mean(lives) if lives.size else np.nan,
    }


def _violent(datasets, name):
    """Return what the response and the branches of a curve tell about its violent motions."""
    response = reading.get(datasets, "response", name)
    design = reading.get(datasets, "harmonic_balance", name)
    branches, free = orbits.of_curve(datasets, name)
    violent, high = high_motions(response, free), orbits.high(branches, free)
    chaos = violent & reading.is_outcome(response, "chaotic")
    runs = runs_of_true(chaos.any("motion").values)
    step = float(response.frequency[1] - response.frequency[0])
    level = orbits.HALF * orbits.resonance(free, design.frequency)
    estimate = np.abs(reading.stable_impacting(design)).max("solution").to_series()
    crossings = orbits.crossings(high, design.frequency)
    ends = response.life_ends.transpose(*chaos.dims).values[chaos.values]
    return {
        "contacts": response.contacts.values[violent.values],
        "fewest": high.fewest.min(),
        "coexisting": orbits.coexisting(high, "contacts"),
        "compared": crossings.assign(a=crossings.frequency.map(estimate[estimate > level])),
        "twins": orbits.high_counterparts(design, branches, free),
        "widest": np.ptp(runs, axis=1).max(initial=0) * step,
        "total": np.ptp(runs, axis=1).sum() * step,
        "starts": float(reading.share_of_starts(response, chaos).max()),
        "lives": ends[ends >= 0] == 0,
    }


def phases(datasets):
    """Return the numbers of claim 7: the masses move in antiphase below Wp, in phase above.

    The phase of Z1 is taken relative to Z2, as in the paper, and relative to x2 = Z1 - Z2.
    """
    of = pd.DataFrame([_phases(datasets, name) for name in BY_MASS])

    def farthest(ratios):
        return ratios[(ratios - 1).abs().idxmax()]

    return {
        "below": of.below.max(),
        "above": of.above.max(),
        "highest": of.highest.min(),
        "in_phase": of.in_phase.max(skipna=False),
        "turn_balance": farthest(of.turn_balance),
        "turn": farthest(of.turn),
        "loose_below": of.loose_below.max(),
        "loose_above": of.loose_above.max(),
        "loose_turn": farthest(of.loose_turn),
    }


def _phases(datasets, name):
    """Return the phases of one damper, from 0.75 Wp to the highest W of harmonic balance."""
    design = reading.get(datasets, "harmonic_balance", name)
    peak = float(design.peak_frequency)
    balance = reading.quiet_balance(design).sel(frequency=slice(0.75 * peak, None))
    quiet = orbits.quiet(*orbits.of_curve(datasets, name))
    near = orbits.smallest(quiet, balance.frequency)
    frequency = near.frequency.to_numpy()
    relative, loose = (np.abs(np.angle(near[key])) for key in ("amplitude", "loose"))
    under = frequency < peak
    if not under.any() or under.all():
        raise Missing(f"There is no quiet orbit on both sides of Wp, branches/{name}")
    apart = np.max(frequency[relative > NEAR], initial=-np.inf)
    return {
        "below": np.max(np.pi - relative[under]),
        "above": relative[-1],
        "highest": frequency[-1],
        "in_phase": min(frequency[frequency > apart], default=np.nan) / peak,
        "turn_balance": reading.crossing(balance.frequency.values, balance.values, 0.0) / peak,
        "turn": reading.crossing(frequency, relative, np.pi / 2) / peak,
        "loose_below": np.max(loose[under]),
        "loose_above": np.pi - loose[-1],
        "loose_turn": reading.crossing(frequency, loose, np.pi / 2) / peak,
    }


def first_collisions(datasets):
    """Return the numbers of claim 8: random starts in a ball of radius 2 lead to collisions."""
    data = list(datasets.get("collisions", {}).values())
    if not data:
        raise Missing("There is no dataset of the stage collisions")
    data = sorted(data, key=lambda each: -reading.parameter(each, "clearance"))

    def numbers(name, ball):
        return [float(each[name].sel(ball=ball)) for each in data]

    return {
        "literal": min(numbers("colliding", "literal")),
        "within_gap": min(numbers("colliding", "within_gap")),
        "beyond_wall": max(numbers("beyond_wall", "literal")),
        "wait": max(numbers("longest_wait", "within_gap")),
        "clearances": [reading.parameter(each, "clearance") for each in data],
        "beyond_walls": numbers("beyond_wall", "literal"),
        "waits": numbers("longest_wait", "within_gap"),
        "starts": max(reading.parameter(each, "starts") for each in data),
    }


def contact_model(datasets):
    """Return the numbers of claim 15: the model is good for high e and fails for low e."""
    used = [
        reading.parameter(data, "restitution")
        for stage in ("response", "optimum")
        for data in reading.damped(datasets, stage).values()
    ]
    used = [value for value in used if value < 1]
    if not used:
        raise Missing("There is no dataset with inelastic contact")
    branches, free = orbits.of_curve(datasets, INELASTIC)
    given = reading.parameter(branches, "restitution")
    return {
        "realised": (orbits.quiet(branches, free).restitution / given - 1).abs().max(),
        "high": max(map(_pull_free_error, used)),
        "low": _pull_free_error(LOW),
        "pulling": 2 * math.asin(damping_ratio(LOW)) / math.pi,
        "duration": _duration(LOW),
    }


def _duration(restitution):
    """Return the time in contact over the time for e = 1."""
    return 1 / math.sqrt(1 - damping_ratio(restitution) ** 2)


def _pull_free_error(restitution):
    """Return the relative excess of the restitution over e if the wall cannot pull.

    The loose mass then leaves the wall when the force, proportional to -y'', vanishes. With the
    damping ratio z and damped frequency wd of the contact this is at wd t = pi - 2 asin(z), while
    the penetration y is still positive.
    """
    damping = damping_ratio(restitution)
    return math.exp(2 * math.asin(damping) * damping * _duration(restitution)) - 1
