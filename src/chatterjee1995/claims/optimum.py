"""Claims 9 and 11, on the optimum clearance (sections 3 and 4, figures 6, 7, 10 and 11).

A sweep is a dataset of the stage `optimum`: the quiet orbit, the small periodic motion for which a
damper is designed, over the clearance d0 at one frequency W. The optimum d0 is the clearance with
the smallest max |Z1|. rm is the mass ratio, h the damping of the oscillator and e the restitution.
Numbers in brackets are equations of the paper: (7) is harmonic balance, (19) its rule for d0. The
band is the range of W in which no motion is large.

Z1 is the displacement of the primary mass.
"""

import itertools

import numpy as np
import pandas as pd

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.bands import smallest_quiet_orbits
from chatterjee1995.claims.claim import Claim, Measure, Missing
from chatterjee1995.claims.findings import motions as motions_findings
from chatterjee1995.claims.suppression import suppression_band

# Relative change of the clearance from its optimum, at which the rise of max |Z1| is evaluated.
AWAY = 0.1


def sweeps(datasets, *keys, **fixed):
    """Return clearance sweeps in groups with equal values of the parameters `keys`.

    The result is a dict of lists, keyed by these values. Only sweeps with the parameter values
    `fixed` are taken, and only groups of two or more sweeps.

    Raises
    ------
    Missing
        If there is no such group.
    """
    groups = {}
    for sweep in datasets.get("optimum", {}).values():
        if all(extract.parameter(sweep, key) == value for key, value in fixed.items()):
            group = tuple(extract.parameter(sweep, key) for key in keys)
            groups.setdefault(group, []).append(sweep)
    groups = {group: members for group, members in groups.items() if len(members) > 1}
    if not groups:
        raise Missing("There are no sweeps of the stage optimum to compare")
    return groups


def displaced(sweep):
    """Return max |Z1| at 10 % below or above the optimum d0, whichever is larger."""
    best = float(sweep.optimum_clearance)
    sizes = np.interp(
        [best * (1 - AWAY), best * (1 + AWAY)],
        sweep.clearance,
        sweep.quiet_displacement,
        left=np.nan,
        right=np.nan,
    )
    return float(np.max(sizes))


def rise(sweep):
    """Return the relative rise of max |Z1| from the optimum d0 to 10 % off it (`displaced`)."""
    return displaced(sweep) / float(sweep.optimum_displacement) - 1


def over_resonance(sweep):
    """Return `displaced` over the amplitude of the resonance without damper, 1/(h W)."""
    damping, frequency = (extract.parameter(sweep, name) for name in ("damping", "frequency"))
    return displaced(sweep) * damping * frequency


def excess(datasets):
    """Return the measures of claim 9: the optimum d0 is slightly higher than by (7).

    Near the optimum max |Z1| hardly varies.
    """
    groups = sweeps(datasets, "damping", restitution=1)
    members = [sweep for group in groups.values() for sweep in group]
    over = [float(sweep.optimum_clearance / sweep.analytical_optimum) - 1 for sweep in members]
    over_rule = [float(sweep.optimum_clearance / sweep.rule_clearance) - 1 for sweep in members]
    rises = [rise(sweep) for sweep in members]
    spreads = []
    for group in groups.values():
        sizes = [float(sweep.optimum_displacement) for sweep in group]
        spreads.append(np.max(sizes) / np.min(sizes) - 1)
    return {
        "dampings": len(groups),
        "least": np.min(over),
        "most": np.max(over),
        "rule_least": np.min(over_rule),
        "rule_most": np.max(over_rule),
        "spread": np.max(spreads),
        "rise_least": np.min(rises),
        "rise": np.max(rises),
        "displaced": np.max([over_resonance(sweep) for sweep in members]),
        "first_harmonic": np.mean([sweep.first_harmonic_share for sweep in members]),
        "straight_flight": np.mean([sweep.straight_flight_share for sweep in members]),
    }


def restitution(datasets):
    """Return the measures of claim 11: lower e widens the band and lowers the optimum d0.

    It also makes max |Z1| over d0 flatter.
    """
    names = (extract.BY_MASS[1], extract.INELASTIC)
    bands = [suppression_band(datasets, name) for name in names]
    design = extract.get(datasets, "harmonic_balance", extract.BY_MASS[1])
    frequency = extract.within(design, *extract.band_edges(design)).frequency
    sharp, soft = (
        smallest_quiet_orbits(*exact_orbits.of_curve(datasets, name), frequency)["size"].to_numpy()
        for name in names
    )
    ratio = soft / sharp
    steps = pd.DataFrame(
        step
        for group in sweeps(datasets, "damping", "frequency", "mass_ratio").values()
        for step in restitution_steps(group)
    )
    worst = steps.loc[np.argmax(steps.clearance.fillna(-np.inf))]
    return {
        "band": bands[1].least_width / bands[0].width,
        "amplitude": float(ratio.min()),
        "most": float(ratio.max()),
        "clearance_least": steps.overall.min(),
        "clearance": steps.overall.max(),
        "step": worst.clearance,
        "step_mass_ratio": worst.mass_ratio,
        "step_from": worst.before,
        "step_to": worst.after,
        "rising": int(np.sum(steps.clearance > 1)),
        "flat": steps.rise.max(),
        "absolute": steps.absolute.max(),
    }


def restitution_steps(group):
    """Return the steps to the next lower e in the sweeps of one mass ratio, each as a dictionary.

    Its entries are

    - `mass_ratio`, and the values `before` and `after` of e;
    - `clearance`: optimum d0 at `after` over optimum d0 at `before`;
    - `rise`: the same ratio for the relative rise of max |Z1| at 10 % from the optimum (`rise`);
    - `absolute`: the same ratio for this rise in units of Z1;
    - `overall`: optimum d0 at the lowest e over optimum d0 at the highest e.
    """
    group = sorted(group, key=lambda sweep: -extract.parameter(sweep, "restitution"))
    overall = float(group[-1].optimum_clearance / group[0].optimum_clearance)
    return [
        {
            "mass_ratio": extract.parameter(soft, "mass_ratio"),
            "before": extract.parameter(hard, "restitution"),
            "after": extract.parameter(soft, "restitution"),
            "clearance": float(soft.optimum_clearance / hard.optimum_clearance),
            "rise": rise(soft) / rise(hard),
            "absolute": _rise_itself(soft) / _rise_itself(hard),
            "overall": overall,
        }
        for hard, soft in itertools.pairwise(group)
    ]


def _rise_itself(sweep):
    """Return the rise of max |Z1| from the optimum d0 to 10 % off it, in units of Z1."""
    return displaced(sweep) - float(sweep.optimum_displacement)


CLAIMS = (
    Claim(
        number="9",
        text="The numerical optimum d0 is slightly higher than the optimum by (7); near it the "
        "response is insensitive to rm and d0, and the damper performs well; this holds for other "
        "h.",
        source="section 3, figures 6 and 7",
        interpretation="Slightly means by a fifth at most. Insensitive to rm means that the least "
        "max |Z1| varies by a fifth at most; insensitive to d0, that max |Z1| rises by a fifth at "
        "most if d0 is changed by 10 % from the optimum. Claim 11 uses this relative rise too. The "
        "damper performs well if max |Z1| is then below 5 % of the free resonance.",
        measures=(
            Measure("dampings", "number of values of h", least=2),
            Measure(
                "least",
                "least relative excess of the optimum d0 over the optimum by (7)",
                least=0,
                decisive=True,
            ),
            Measure(
                "most",
                "largest relative excess of the optimum d0 over the optimum by (7)",
                most=0.2,
            ),
            Measure("rule_least", "least relative excess of the optimum d0 over (19)"),
            Measure("rule_most", "largest relative excess of the optimum d0 over (19)"),
            Measure("spread", "largest relative spread of the least max |Z1| over rm", most=0.2),
            Measure("rise_least", "least relative rise of max |Z1| at 10 % from the optimum d0"),
            Measure(
                "rise", "largest relative rise of max |Z1| at 10 % from the optimum d0", most=0.2
            ),
            Measure(
                "displaced",
                "largest max |Z1| at 10 % from the optimum d0 over the free resonance",
                most=0.05,
                decisive=True,
            ),
            Measure(
                "first_harmonic",
                "mean share of the excess that the first harmonic of a straight flight explains "
                "(rm W^2 d0 = pi^2/8)",
            ),
            Measure(
                "straight_flight",
                "mean share of the excess that the smallest maximum of a straight flight explains",
            ),
        ),
        evidence=excess,
        finding=motions_findings.optimum,
        figures=("figure_06", "figure_07"),
    ),
    Claim(
        number="11",
        text="Inelastic collisions widen the band and raise the amplitude in it; the lower e, "
        "the lower the optimum d0 and the flatter the response.",
        source="section 4, figures 10 and 11",
        interpretation="The width is judged by the motions that exist, as in claim 4, and the "
        "amplitude by max |Z1| of the smallest stable orbits of period 1 in the elastic band. The "
        "paper calls the rise of the amplitude marginal, which is read as a factor of 1.5 at "
        "most. The optimum d0 is taken for the e of figure 11, 0.75 and 0.9, and for e = 1. "
        "Flatter means a smaller relative rise of max |Z1| if d0 is changed by 10 % from the "
        "optimum, as in claim 9.",
        measures=(
            Measure(
                "band",
                "lower bound of the width for e = 0.75 over the width for e = 1",
                least=1,
                decisive=True,
            ),
            Measure(
                "amplitude",
                "least ratio of the amplitude for e = 0.75 to the amplitude for e = 1",
                least=1,
                decisive=True,
            ),
            Measure(
                "most",
                "largest ratio of these amplitudes, marginally above 1 according to the paper",
                most=1.5,
            ),
            Measure(
                "clearance_least",
                "least ratio of the optimum d0 at the smallest e to the optimum d0 at the largest "
                "e",
            ),
            Measure(
                "clearance",
                "largest ratio of the optimum d0 at the smallest e to the optimum d0 at the "
                "largest e",
                most=1,
                decisive=True,
            ),
            Measure(
                "step",
                "largest ratio of the optimum d0 to the optimum d0 at the next larger e",
                most=1,
            ),
            Measure("step_mass_ratio", "rm of this ratio"),
            Measure("step_from", "next larger e of this ratio"),
            Measure("step_to", "e of this ratio"),
            Measure("rising", "number of such ratios above 1"),
            Measure(
                "flat",
                "largest ratio of the relative rise of max |Z1| at 10 % from the optimum d0 to the "
                "rise at the next larger e",
                most=1,
            ),
            Measure("absolute", "the same ratio of the rise in Z1 itself"),
        ),
        evidence=restitution,
        finding=motions_findings.restitution,
        figures=("figure_11", "figure_10"),
    ),
)
