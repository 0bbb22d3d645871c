"""Claims 1 and 2, on solutions of harmonic balance (sections 2 and 3).

Equation (7) of the paper is harmonic balance with elastic contacts, equation (14) its limit of
rigid walls. a is the amplitude of the primary mass, rm the mass ratio, d0 the clearance and W the
forcing frequency, with the value Wp at the peak of the response without the damper. Rule (19) is
rm Wp^2 d0 = 1. A solution is called impacting if the loose mass touches the walls.

A stage is a step of the workflow.
"""

import numpy as np
import pandas as pd

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import Claim, Measure, Missing
from chatterjee1995.claims.findings import balance as balance_findings
from impact_damper.data.datasets import flag

# An orbit agrees with a solution of (7) if their amplitudes differ relatively by at most NEAR.
NEAR = 0.1


def small_motion(datasets):
    """Return the measures of claim 1: at rm W^2 d0 = 1, (14) and (7) have a small stable solution.

    They are computed by harmonic balance for dampers whose clearance follows rule (19), and from
    the exact periodic orbits for the dampers of figures 5 and 8.
    """
    designs = extract.select(datasets, "harmonic_balance", extract.RULES)
    vanishing = []
    for design in designs:
        peak = float(design.peak_frequency)
        roots = extract.within(design, 0.9 * peak, 1.1 * peak).rigid_amplitude
        smallest = roots.isel(root=np.abs(roots).fillna(np.inf).argmin("root"))
        frequency = extract.crossing(smallest.frequency.values, smallest.values, 0.0)
        inertia = extract.parameter(design, "mass_ratio") * frequency**2
        vanishing.append(abs(inertia * extract.parameter(design, "clearance") - 1))
    sizes = [float(design.quiet_amplitude / design.peak_amplitude) for design in designs]
    orbits = []
    for name in extract.ELASTIC:
        branches, free = exact_orbits.of_curve(datasets, name)
        peak = float(extract.get(datasets, "harmonic_balance", name).peak_frequency)
        small = exact_orbits.smallest(exact_orbits.quiet(branches, free), peak)["size"]
        orbits.append(small.min() / exact_orbits.resonance_fold(free)[1])
    return {
        "vanishing": np.max(vanishing),
        "size": np.nanmax([*sizes, 0.0]),
        "stable": np.mean(np.isfinite(sizes)),
        "orbits": np.mean(np.isfinite(orbits)),
        "orbit_size": np.nanmax([*orbits, 0.0]),
        "designs": len(designs),
        "dampers": len(orbits),
    }


def rigid_against_elastic(datasets):
    """Return the measures of claim 2: the larger solutions of (14) and (7) agree.

    The smallest solution at each frequency is left out. Exact periodic orbits are compared with (7)
    as well.
    """
    designs = extract.damped(datasets, "harmonic_balance").values()
    if not designs:
        raise Missing("There is no dataset of the stage harmonic_balance with a damper")
    errors, alike, pulling = [], [], []
    for design in designs:
        pulling.append((design.rigid_wall == flag("rigid_wall", "pulls")).any("root").values)
        impacting = design.kind == flag("kind", "impacting")
        pushing = design.rigid_wall == flag("rigid_wall", "pushes")
        elastic = np.sort(design.amplitude.where(impacting).values)
        rigid = np.sort(design.rigid_amplitude.where(pushing).values)
        for a, limit in zip(elastic, rigid, strict=True):
            a, limit = a[np.isfinite(a)], limit[np.isfinite(limit)]
            alike.append(len(a) == len(limit))
            if alike[-1] and len(a) > 1:
                larger = np.arange(len(a)) != np.argmin(np.abs(a))
                errors.append(np.max(np.abs(limit - a)[larger] / np.abs(a)[larger]))
    pairs = pd.concat(
        [
            exact_orbits.counterparts(
                extract.get(datasets, "harmonic_balance", name),
                exact_orbits.of_curve(datasets, name)[0],
            )
            for name in extract.ELASTIC
        ]
    )
    larger = pairs[~pairs.least]
    near = larger[larger.difference <= NEAR]
    return {
        "alike": np.mean(alike),
        "error": np.max(errors, initial=0.0) if errors else np.nan,
        "pulling": np.mean(np.concatenate(pulling)),
        "orbits": len(near) / len(larger) if len(larger) else np.nan,
        "orbits_stable": near.stable.mean(),
        "orbit_error": near.difference.median(),
    }


CLAIMS = (
    Claim(
        number="1",
        text="With rm W^2 d0 = 1 one root of (14) has zero amplitude; (7) gives a small amplitude, "
        "stable by appendix A.",
        source="section 3",
        interpretation="Near the peak frequency, for the designs with the clearance of (19), and "
        "for the exact orbits of the dampers of figures 5 and 8, whose rm Wp^2 d0 is within 4 % "
        "of 1. A small motion is a quiet one, of period 1 and below half of the free resonance.",
        measures=(
            Measure(
                "vanishing",
                "|rm W^2 d0 - 1| at the frequency where a root of (14) has a = 0",
                most=0.005,
                decisive=True,
            ),
            Measure(
                "stable",
                "share of designs by (19) with a stable small solution of (7) at Wp",
                least=1,
                decisive=True,
            ),
            Measure(
                "size",
                "largest ratio of the amplitude of this solution to the free resonance amplitude",
                most=0.05,
                decisive=True,
            ),
            Measure(
                "orbits",
                "share of the dampers of figures 5 and 8 with a stable small orbit at Wp",
                least=1,
                decisive=True,
            ),
            Measure(
                "orbit_size",
                "largest ratio of max |Z1| of this orbit to the free resonance",
                most=0.05,
                decisive=True,
            ),
        ),
        evidence=small_motion,
        finding=balance_findings.small_motion,
        figures=("figure_03c",),
    ),
    Claim(
        number="2",
        text="All impacting solutions of (14) and (7) but the smallest agree very closely.",
        source="section 3",
        interpretation="Roots of (14) with walls that push are compared with the solutions of (7) "
        "at the same W, for all designs of figures 3, 5 and 8. A wall pushes if its force, "
        "rm W^2 (d0 - a), is positive, as (10) supposes with eps > 0. The smallest |a| at each W "
        "is left out. Very closely means within 5 %. In addition these solutions of (7) are "
        "compared with the first harmonic of the nearest exact orbit with two symmetric contacts, "
        "stable or not, for the dampers of figures 5 and 8. Orbits on "
        "branches without any stable part are not known.",
        measures=(
            Measure(
                "alike",
                "share of W at which (7) has as many solutions as (14) has roots with walls that "
                "push",
                least=0.9,
                decisive=True,
            ),
            Measure(
                "error", "largest relative difference of the amplitudes", most=0.05, decisive=True
            ),
            Measure("pulling", "share of W at which (14) also has roots with walls that pull"),
            Measure(
                "orbits",
                "share of these solutions of (7) with an orbit whose first harmonic is within 10 % "
                "of a",
            ),
            Measure(
                "orbits_stable", "share of the solutions with such an orbit whose orbit is stable"
            ),
            Measure(
                "orbit_error",
                "median relative difference between the first harmonic of these orbits and a",
            ),
        ),
        evidence=rigid_against_elastic,
        finding=balance_findings.rigid_against_elastic,
    ),
)
