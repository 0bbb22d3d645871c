"""Numbers that test claims 5 to 8 and 15, on contacts, chaos and phases. Wp: peak frequency."""

import math

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.bands import high_motions
from chatterjee1995.reading.datasets import BY_MASS, ELASTIC, INELASTIC, Missing
from impact_damper.data.sweeps import runs_of_true
from impact_damper.model.exit_rules import damping_ratio

LOW = 0.3  # example of a low restitution in claim 15


def quiet_contacts(datasets):
    """Return numbers that test claim 5: the quiet motion has two symmetric impacts in a cycle."""
    shares, skew = [], []
    for name in ELASTIC:
        lower, upper = reading.band_edges(reading.get(datasets, "harmonic_balance", name))
        quiet = orbits.quiet(*orbits.of_curve(datasets, name))
        in_band = quiet[(quiet.upper > lower) & (quiet.lower < upper)]
        others = in_band[(in_band.fewest != 2) | (in_band.contacts != 2)]
        width = orbits.covered(in_band, lower, upper) - orbits.covered(others, lower, upper)
        shares.append(width / (upper - lower))
        skew.append(in_band.asymmetry.max())
    return {"two": np.min(shares), "skew": np.max(skew)}


def high_and_chaotic(datasets):
    """Return numbers that test claim 6: violent motions have more than two impacts a cycle."""
    of = pd.DataFrame([_violent(datasets, name) for name in ELASTIC], index=ELASTIC)
    contacts, differences = (
        np.concatenate(of[name].tolist()) for name in ("contacts", "differences")
    )
    if len(contacts) == 0 or len(differences) == 0:
        raise Missing(
            "There is no violent motion, or no stable violent orbit at a W at which (7) has a "
            "stable violent solution"
        )
    return {
        "more": np.mean(contacts > 2 + 1e-6),
        "fewest": of.fewest.min(),
        "harmonic": np.median(differences),
        "coexisting": of.coexisting.max(),
        "coexisting_in": of.coexisting.idxmax(),
        "widest": of.widest.max(),
        "widest_in": of.widest.idxmax(),
    }


def _violent(datasets, name):
    response = reading.get(datasets, "response", name)
    design = reading.get(datasets, "harmonic_balance", name)
    branches, free = orbits.of_curve(datasets, name)
    violent, high = high_motions(response, free), orbits.high(branches, free)
    chaos = (violent & reading.is_outcome(response, "chaotic")).any("motion")
    step = float(response.frequency[1] - response.frequency[0])
    level = orbits.HALF * orbits.resonance(free, design.frequency)
    estimate = np.abs(reading.stable_impacting(design)).max("solution").to_series()
    crossings = orbits.crossings(high, design.frequency)
    harmonic = crossings.frequency.map(estimate[estimate > level]) / crossings.amplitude.abs()
    return {
        "contacts": response.contacts.values[violent.values],
        "differences": np.abs(harmonic - 1).dropna(),
        "fewest": high.fewest.min(),
        "coexisting": orbits.coexisting(high, "contacts"),
        "widest": np.ptp(runs_of_true(chaos.values), axis=1).max(initial=0) * step,
    }


def phases(datasets):
    """Return numbers that test claim 7: the masses move in antiphase below the resonance peak."""
    of = pd.DataFrame([_phases(datasets, name) for name in BY_MASS])
    turns = {key: of[key][(of[key] - 1).abs().idxmax()] for key in ("turn_balance", "turn")}
    return of.max().to_dict() | turns | {"highest": of.highest.min()}


def _phases(datasets, name):
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
    return {
        "below": np.max(np.pi - relative[under]),
        "above": relative[-1],
        "highest": frequency[-1],
        "turn_balance": reading.crossing(balance.frequency.values, balance.values, 0.0) / peak,
        "turn": reading.crossing(frequency, relative, np.pi / 2) / peak,
        "loose_below": np.max(loose[under]),
        "loose_above": np.pi - loose[-1],
    }


def first_collisions(datasets):
    """Return numbers that test claim 8: random starts within a ball of radius 2 lead to impacts."""
    data = list(datasets.get("collisions", {}).values())
    if not data:
        raise Missing("There is no dataset of the stage collisions")
    return {
        "literal": min(float(each.colliding.sel(ball="literal")) for each in data),
        "within_gap": min(float(each.colliding.sel(ball="within_gap")) for each in data),
        "beyond_wall": max(float(each.beyond_wall.sel(ball="literal")) for each in data),
        "wait": max(float(each.longest_wait.sel(ball="within_gap")) for each in data),
    }


def contact_model(datasets):
    """Return numbers that test claim 15: the contact model is good for high restitution only."""
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
        "duration": _duration(LOW),
    }


def _duration(restitution):
    return 1 / math.sqrt(1 - damping_ratio(restitution) ** 2)


def _pull_free_error(restitution):
    """Return (realised restitution)/(given restitution) - 1 for walls that cannot pull."""
    damping = damping_ratio(restitution)
    return math.exp(2 * math.asin(damping) * damping * _duration(restitution)) - 1
