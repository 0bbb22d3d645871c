"""Claim 7, on the phase between primary and loose mass (section 3, figure 5).

Z1 is the displacement of the primary mass, x2 that of the loose mass, and Z2 = Z1 - x2. Wp is the
forcing frequency W at the peak of the resonance without the damper. A quiet orbit is a small
periodic motion with the damper.
"""

import numpy as np

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import Claim, Measure, Missing
from chatterjee1995.claims.findings import balance as balance_findings

NEAR = 0.3  # phase in radians up to which two motions are almost in phase, or almost in antiphase


def phases(datasets):
    """Return the measures of claim 7: the masses move in antiphase below Wp, in phase above.

    They are computed for the phase of Z1 relative to Z2, as in the paper, and relative to x2.
    """
    below, above, turns, balance, loose_below, loose_above, loose_turns = ([] for _ in range(7))
    highest, in_phase = [], []
    for name in extract.BY_MASS:
        design = extract.get(datasets, "harmonic_balance", name)
        peak = float(design.peak_frequency)
        around = extract.quiet_balance(design).sel(frequency=slice(0.75 * peak, None))
        near = exact_orbits.smallest(
            exact_orbits.quiet(*exact_orbits.of_curve(datasets, name)), around.frequency
        )
        frequency = near.frequency.to_numpy()
        relative, loose = (np.abs(np.angle(near[key])) for key in ("amplitude", "loose"))
        under = frequency < peak
        if not under.any() or under.all():
            raise Missing(f"There is no quiet orbit on both sides of Wp, branches/{name}")
        below.append(np.max(np.pi - relative[under]))
        above.append(relative[-1])
        highest.append(frequency[-1])
        apart = np.max(frequency[relative > NEAR], initial=-np.inf)
        in_phase.append(min(frequency[frequency > apart], default=np.nan) / peak)
        loose_below.append(np.max(loose[under]))
        loose_above.append(np.pi - loose[-1])
        turns.append(extract.crossing(frequency, relative, np.pi / 2) / peak)
        loose_turns.append(extract.crossing(frequency, loose, np.pi / 2) / peak)
        balance.append(extract.crossing(around.frequency.values, around.values, 0.0) / peak)

    def farthest(ratios):
        return ratios[np.argmax(np.abs(np.array(ratios) - 1))]

    return {
        "below": np.max(below),
        "above": np.max(above),
        "highest": np.min(highest),
        "in_phase": np.max(in_phase),
        "turn_balance": farthest(balance),
        "turn": farthest(turns),
        "loose_below": np.max(loose_below),
        "loose_above": np.max(loose_above),
        "loose_turn": farthest(loose_turns),
    }


CLAIMS = (
    Claim(
        number="7",
        text="Primary and loose mass move almost in antiphase for W < Wp, almost in phase for W > "
        "Wp.",
        source="section 3, figure 5",
        interpretation="The phase is taken between Z1 and Z2, as in (6d): the sign of a, by (7) "
        "exactly 0 or pi. The phase between Z1 and the displacement x2 = Z1 - Z2 of the loose "
        "mass is the opposite where |a| < b, and is given too. The phases are those of the first "
        "harmonics of the smallest stable orbit of period 1, from 0.75 Wp to the highest W "
        "computed. The least favourable of the dampers of figure 5 counts. Almost means within "
        "0.3 rad: at all W below Wp, and at the highest W above. For full agreement the phase "
        "changes within 5 % of Wp.",
        measures=(
            Measure(
                "below",
                "largest distance in rad of the phase of Z1 to Z2 from antiphase below Wp",
                most=NEAR,
                decisive=True,
            ),
            Measure(
                "above",
                "largest phase in rad of Z1 to Z2 at the highest W",
                most=NEAR,
                decisive=True,
            ),
            Measure("highest", "highest W"),
            Measure("in_phase", "W/Wp from which on this phase is below 0.3 rad"),
            Measure(
                "turn_balance",
                "W/Wp at which a changes sign by harmonic balance",
                least=0.95,
                most=1.05,
            ),
            Measure(
                "turn",
                "W/Wp at which Z1 and Z2 are a quarter of a cycle apart, exact orbits",
                least=0.95,
                most=1.05,
            ),
            Measure("loose_below", "largest phase in rad of Z1 to x2 below Wp"),
            Measure(
                "loose_above",
                "largest distance in rad of the phase of Z1 to x2 from antiphase at the highest W",
            ),
            Measure(
                "loose_turn", "W/Wp at which Z1 and x2 are a quarter of a cycle apart, exact orbits"
            ),
        ),
        evidence=phases,
        finding=balance_findings.phases,
    ),
)
