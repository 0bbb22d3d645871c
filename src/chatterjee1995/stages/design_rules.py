"""Accuracy of design rules: the clearance by each rule, compared with the exact optimum.

The optimum is the clearance at which the quiet orbit is smallest. A clearance is given as the ratio
rm W^2 d0/f, and a displacement as W^2 Z1/f. f is the forcing amplitude. Rule (18) has the ratio 1.
"""

import itertools

import numpy as np
from scipy.optimize import minimize_scalar
from tqdm import tqdm

from chatterjee1995.methods.quiet_orbits import CRITERIA, RULES, compliant_orbit, rule_ratios
from impact_damper.data.datasets import dataset, flag
from impact_damper.data.variables import register
from impact_damper.model.packed import CLEARANCE, FREQUENCY, pack
from impact_damper.model.parameters import Damper, describe
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, strobe_time
from impact_damper.motions.traces import states_at
from impact_damper.theory.straight_flight import flight_of

register(
    """
criterion | criterion | | | quantity that is smallest at an optimum
rule | rule | | | rule for the clearance
best_ratio | mass_ratio restitution contact_stiffness frequency criterion | | | r_m Omega^2 d0
  (dimensionless clearance) at the optimum
best_kind | mass_ratio restitution contact_stiffness frequency criterion | | | kind of minimum
  : optimum_kind
best_stability | mass_ratio restitution contact_stiffness frequency criterion | |  | stability of
  the motion at the optimum
  : stability
rule_ratio | mass_ratio restitution contact_stiffness frequency criterion rule | | | r_m Omega^2
  d0 by the rule
rule_excess | mass_ratio restitution contact_stiffness frequency rule | | | relative excess of max
  |Z1|, at the clearance by the rule, above the smallest max |Z1|
    """
)

SWEPT = ("mass_ratio", "restitution", "contact_stiffness", "frequency")
SAMPLES = 1024  # number of values of Z1 in a cycle from which the first harmonic is computed
SAME = 1e-4  # largest asymmetry of a symmetric orbit, divided by the clearance
# The search for the least displacement changes the ratio rm W^2 d0/f by the fraction STEP, at most
# MOST_STEPS times. Then it locates the minimum, with an error of the ratio up to PRECISION.
STEP, MOST_STEPS, PRECISION = 0.02, 40, 1e-8
# A minimum is a kink if the rise of the displacement at the distance CLOSE/2 exceeds KINK times the
# rise at the distance CLOSE. The ratio of both rises is 1/4 at a smooth minimum, and 1/2 at a kink.
CLOSE, KINK = 1e-3, 0.36
ABSENT = 1e3  # displacement that the search assumes where no orbit exists
IMPULSES = 400  # number of impulses for which the theory of straight flight is evaluated


def design_rules(
    oscillator, mass_ratios, restitutions, contact_stiffnesses, frequencies, *, progress=None
):
    """Return a dataset: the optimum clearances for each damper and frequency.

    It also holds the errors of several rules for these clearances.
    """
    given = mass_ratios, restitutions, contact_stiffnesses, frequencies
    axes = {name: np.array(values, float) for name, values in zip(SWEPT, given, strict=True)}
    shape = tuple(map(len, axes.values()))
    cells = list(itertools.product(*axes.values()))
    cells = tqdm(cells, progress, disable=progress is None, ascii=True)
    rows = [_cell(oscillator, *values) for values in cells]
    data = {
        name: np.array([row[name] for row in rows]).reshape(*shape, *np.shape(first))
        for name, first in rows[0].items()
    }
    coordinates = axes | {"criterion": list(CRITERIA), "rule": list(RULES)}
    return dataset(data, coordinates, describe(oscillator), "Rules for the optimum clearance")


def _cell(oscillator, mass_ratio, restitution, contact_stiffness, frequency):
    damper = Damper(mass_ratio, 1.0, restitution, contact_stiffness)
    rules = rule_ratios(oscillator, damper, frequency)
    motion = QuietMotion(oscillator, damper, frequency)
    optima = [motion.least(i, rules[i, -1]) for i in range(len(CRITERIA))]
    ratios = np.array([ratio for ratio, _ in optima])
    found = [motion.at(ratio) for ratio in ratios]
    reached = np.array([motion.at(ratio)[0] for ratio in rules[0]])
    multiplier = np.array([values[-1] for values in found])
    stability = ["absent" if np.isnan(m) else "stable" if m < 1 else "unstable" for m in multiplier]
    return {
        "best_ratio": ratios,
        "best_kind": [flag("best_kind", kind) for _, kind in optima],
        "best_stability": [flag("best_stability", each) for each in stability],
        "rule_ratio": rules,
        "rule_excess": np.where(np.isfinite(reached), reached / found[0][0] - 1, np.nan),
    }


class QuietMotion:
    """The quiet orbit at any ratio rm W^2 d0/f. f is the amplitude of the forcing."""

    def __init__(self, oscillator, damper, frequency):
        flight = flight_of(oscillator, damper, frequency)
        self._parameters = pack(oscillator, damper, frequency)
        self._forcing = oscillator.forcing_amplitude(frequency)
        self._unit = self._forcing / (damper.mass_ratio * frequency**2)
        self._known = {}
        impulse = np.linspace(0, flight.largest_impulse, IMPULSES + 2)[1:-1]
        strobe = np.pi / 2 + flight.forced_lag
        x, speed, _ = flight.motion(strobe, impulse)
        loose = -impulse / damper.mass_ratio * (1 - 2 / np.pi * (strobe - flight.lag(impulse)))
        loose_speed = 2 / np.pi * impulse / damper.mass_ratio
        self._ratios = flight.ratio(impulse)
        self._states = np.array([x, speed, x - loose, speed - loose_speed])
        self._states /= np.array([[frequency**2, frequency] * 2]).T / self._forcing

    def at(self, ratio):
        """Return max |Z1|, the first harmonic of Z1 (both times W^2/forcing), and |multiplier|."""
        if ratio not in self._known:
            self._known[ratio] = self._orbit(ratio)
        return self._known[ratio]

    def _orbit(self, ratio):
        absent = np.inf, np.inf, np.nan
        if not self._ratios[0] < ratio < self._ratios[-1] or ratio <= 0:
            return absent
        p = self._parameters.copy()
        p[CLEARANCE] = ratio * self._unit
        guess = np.array([np.interp(ratio, self._ratios, each) for each in self._states])
        orbit, _ = compliant_orbit(p, guess, p[CLEARANCE] / 2, asymmetry=SAME * p[CLEARANCE])
        if orbit is None:
            return absent
        sizes = orbit.displacement, abs(first_harmonic(p, orbit.state))
        scale = p[FREQUENCY] ** 2 / self._forcing
        return *(scale * size for size in sizes), abs(orbit.multiplier)

    def least(self, criterion, guess):
        """Return the ratio near `guess` at which `at(ratio)[criterion]` is least, and a kind.

        The kind is "smooth" or "kink"; "jump" if the orbits end within CLOSE of the minimum; "edge"
        if MOST_STEPS steps do not reach a minimum; "not_found" if there is no orbit at `guess`.
        """
        middle, lower, upper = guess, guess * (1 - STEP), guess * (1 + STEP)

        def size(ratio):
            return self.at(ratio)[criterion]

        if not np.isfinite(size(guess)):
            return np.nan, "not_found"
        for _ in range(MOST_STEPS):
            lower, upper = middle * (1 - STEP), middle * (1 + STEP)
            lowest = min((middle, lower, upper), key=size)
            if lowest == middle:
                break
            middle = lowest
        else:
            return middle, "edge"
        found = minimize_scalar(
            lambda ratio: min(size(ratio), ABSENT),
            bounds=(lower, upper),
            method="bounded",
            options={"xatol": PRECISION},
        ).x
        if not np.isfinite([size(found - CLOSE), size(found + CLOSE)]).all():
            return found, "jump"
        rises = [size(found - h) + size(found + h) - 2 * size(found) for h in (CLOSE, CLOSE / 2)]
        return found, "kink" if rises[1] > KINK * rises[0] else "smooth"


def first_harmonic(p, y) -> complex:
    """Return the complex amplitude of the first harmonic of Z1, with an error below 1e-5."""
    start = strobe_time(p)
    times = start + np.arange(SAMPLES + 1) * 2 * np.pi / (p[FREQUENCY] * SAMPLES)
    states = states_at(p, y, start, times, POLISH_TOLERANCE)
    return 2 * np.mean(states[:-1, 0] * np.exp(-1j * p[FREQUENCY] * times[:-1]))
