"""Numbers that test claims 4, 16 and 17, on the suppression band and the amplitudes in it."""

import itertools

import numpy as np

from chatterjee1995.claims.balance import design_multipliers
from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.bands import suppression_band
from chatterjee1995.reading.datasets import Missing
from impact_damper.data.datasets import oscillator_of


def widening(datasets):
    """Return numbers on claim 4: larger omega_l, larger rm or lower restitution widens bands."""
    stiffer, heavier = (
        [reading.select(datasets, "harmonic_balance", names) for names in series]
        for series in ((reading.CAPTIONS, reading.RULES), (reading.BY_MASS,))
    )
    existing = [suppression_band(datasets, name) for name in reading.BY_MASS]
    steps = [wider.least_width / band.width for band, wider in itertools.pairwise(existing)]
    inelastic = suppression_band(datasets, reading.INELASTIC)
    return {
        "linear": _growth(stiffer, lambda design: design.band_width),
        "relative": _growth(stiffer, lambda design: design.band_width / design.peak_frequency),
        "mass": _growth(heavier, lambda design: design.band_width),
        "existing": np.min(steps),
        "restitution": inelastic.least_width / existing[1].width,
        "reduction": max(
            100 * np.ptp([float(design.reduction) for design in designs]) for designs in stiffer
        ),
        "orbit_reduction": max(
            100 * np.ptp(_remaining(datasets, names)) for names in (reading.CAPTIONS, reading.RULES)
        ),
        "designs_stable": np.mean(design_multipliers(datasets) < 1),
    }


def _growth(series, width):
    return min(
        float(width(after) / width(before))
        for designs in series
        for before, after in itertools.pairwise(designs)
    )


def _remaining(datasets, names):
    return [
        float(reading.design_point(orbit).orbit_displacement)
        / orbits.resonance_fold(orbits.free_of(datasets, orbit))[1]
        for orbit in reading.select(datasets, "design_orbit", names)
    ]


def accuracy(datasets):
    """Return numbers that test claim 16: harmonic balance predicts the suppression band."""
    widths, shares, factors, harmonics = [], [], [], []
    for name in reading.ELASTIC:
        design = reading.get(datasets, "harmonic_balance", name)
        branches, free = orbits.of_curve(datasets, name)
        lower, upper = reading.band_edges(design)
        band = suppression_band(datasets, name)
        ratios = [(upper - lower) / width for width in (band.width, band.least_width)]
        widths.append(max(abs(ratio - 1) for ratio in ratios))
        estimate = np.abs(reading.quiet_balance(reading.within(design, lower, upper)))
        found = orbits.smallest_quiet(branches, free, estimate.frequency)
        size, first = found["size"].to_numpy(), np.abs(found.amplitude.to_numpy())
        shares.append(float(np.max(np.abs(size - estimate.values)) / design.peak_amplitude))
        factors.append(_factor(size.mean(), float(estimate.mean())))
        harmonics.append(_factor(first.mean(), float(estimate.mean())))
    return {
        "typical": np.median(widths),
        "width": np.max(widths),
        "typical_factor": np.median(factors),
        "factor": np.max(factors),
        "harmonic": np.max(harmonics),
        "share": np.max(shares),
    }


def _factor(one, other):
    return max(one / other, other / one)


def amplitude_by_mass(datasets):
    """Return numbers that test claim 17: a heavier loose mass lowers the amplitude in the band."""
    designs = reading.select(datasets, "harmonic_balance", reading.BY_MASS)
    edges = np.array([reading.band_edges(design) for design in designs])
    parts = [reading.within(each, edges[:, 0].max(), edges[:, 1].min()) for each in designs]
    sizes = [
        orbits.smallest_quiet(*orbits.of_curve(datasets, name), part.frequency)["size"].mean()
        for name, part in zip(reading.BY_MASS, parts, strict=True)
    ]
    balance = [float(np.abs(reading.quiet_balance(part)).mean()) for part in parts]
    ruled = [
        float(sweep.quiet_displacement.interp(clearance=sweep.rule_clearance))
        for sweep in _elastic_sweeps(datasets, designs[0])
    ]
    return {
        "whole": float(sizes[-1] / sizes[0]),
        "rule": ruled[-1] / ruled[0],
        "steps": np.max(np.divide(sizes[1:], sizes[:-1])),
        "balance": np.max(np.divide(balance[1:], balance[:-1])),
    }


def _elastic_sweeps(datasets, design):
    found = [
        sweep
        for sweep in datasets.get("optimum", {}).values()
        if oscillator_of(sweep) == oscillator_of(design)
        and reading.parameter(sweep, "restitution") == 1
    ]
    if len(found) < 2:
        raise Missing("There are no two elastic sweeps of the stage optimum for figure 5")
    return sorted(found, key=lambda sweep: reading.parameter(sweep, "mass_ratio"))
