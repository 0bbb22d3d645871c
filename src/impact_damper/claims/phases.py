"""Claim 7, on the phases of the quiet motion (section 3, figure 5)."""

import numpy as np

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Claim, Missing, Number


def phases(datasets):
    """Numbers of claim 7, in both readings."""
    below, above, turns, balance, loose_below, loose_above, loose_turns = ([] for _ in range(7))
    for name in extract.BY_MASS:
        design = extract.get(datasets, "design", name)
        peak = float(design.peak_frequency)
        around = extract.quiet_balance(design).sel(frequency=slice(0.75 * peak, None))
        near = exact.smallest(exact.quiet(*exact.of_curve(datasets, name)), around.frequency)
        frequency = near.frequency.to_numpy()
        relative, loose = (np.abs(np.angle(near[key])) for key in ("amplitude", "loose"))
        under = frequency < peak
        if not under.any() or under.all():
            raise Missing(f"There is no quiet orbit on both sides of Wp, branches/{name}")
        below.append(np.max(np.pi - relative[under]))
        above.append(relative[-1])
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
        "turn_balance": farthest(balance),
        "turn": farthest(turns),
        "loose_below": np.max(loose_below),
        "loose_above": np.max(loose_above),
        "loose_turn": farthest(loose_turns),
    }


CLAIMS = (
    Claim(
        "7",
        "Primary and loose mass move almost in antiphase for W < Wp, almost in phase for W > Wp.",
        "section 3, figure 5",
        "The paper's phase is that of Z1 to Z2, the sign of a; for the place x2 = Z1 - Z2 of the "
        "loose mass it is the reverse where |a| < b. The smallest stable orbit of period 1, from "
        "0.75 Wp on; phases of the first harmonics in radian; almost: within 0.3. Of three dampers "
        "the worst.",
        (
            Number(
                "below",
                "largest distance to antiphase of Z1 and Z2 below Wp",
                most=0.3,
                decisive=True,
            ),
            Number(
                "above",
                "largest distance to phase of Z1 and Z2 at the highest W",
                most=0.3,
                decisive=True,
            ),
            Number(
                "turn_balance",
                "W/Wp where a changes sign by harmonic balance",
                least=0.95,
                most=1.05,
            ),
            Number(
                "turn", "W/Wp where Z1 and Z2 are a quarter apart, orbits", least=0.95, most=1.05
            ),
            Number("loose_below", "largest distance to phase of Z1 and x2 below Wp"),
            Number("loose_above", "largest distance to antiphase of Z1 and x2 at the highest W"),
            Number("loose_turn", "W/Wp where Z1 and x2 are a quarter apart"),
        ),
        phases,
    ),
)
