"""Absorbers that one could build in place of an impact damper, and how far the machine moves.

`absorber_responses` compares, for one machine and one added mass, over forcing frequencies and
forcing amplitudes, each with its stiffness as designed and detuned:

    bare        the machine alone
    tuned       the absorber tuned exactly to the machine, with a linear spring
    nonlinear   the tuned absorber with a cubic spring added that keeps the peaks equal
    best        the absorber that minimises the largest displacement at the machine's own force
"""

import json

import numpy as np

from impact_damper.absorbers.absorber import check_mass
from impact_damper.absorbers.direct import best_absorber
from impact_damper.absorbers.linear_response import response
from impact_damper.absorbers.peaks import linear_peak, orbit_peaks
from impact_damper.absorbers.problems import problems_of
from impact_damper.absorbers.search import Search, search
from impact_damper.absorbers.tuning import check_band, exact_absorber, with_cubic
from impact_damper.data.datasets import dataset, flag
from impact_damper.machine.machine import Machine
from impact_damper.machine.results import in_si
from impact_damper.system.bounds import MOST_RUNS, SEED_RANGE, check_count, shown
from impact_damper.system.checks import check_numbers

COMPETITORS = ("bare", "tuned", "nonlinear", "best")
# Factors of the excitation, from a quarter to four times the machine's.
SHARES = tuple(2.0 ** (step / 2) for step in range(-4, 5))
DETUNINGS = (-0.1, 0.0, 0.1)
SPRING = ("stiffness", "damping", "cubic_stiffness")
PEAK = ("competitor_peak", "competitor_peak_frequency")
# Variables for the fields of `search.Search`.
NAMES = dict(
    zip(
        Search._fields,
        ("displacement", "least_displacement", "motions", "share", "escaped", "status"),
        strict=True,
    )
)


def absorber_responses(
    machine,
    mass,
    frequencies,
    force_shares=SHARES,
    *,
    detunings=DETUNINGS,
    band=None,
    starts=4,
    seed=1995,
):
    """Return the displacements of a machine without and with tuned absorbers.

    With linear springs the response has a closed form. Otherwise the motions are exact periodic
    orbits, and random starts show that none of those they reach is missing.

    Parameters
    ----------
    machine : Machine
    mass : float, str or pint.Quantity
        Mass of each absorber, kg.
    frequencies : sequence of float
        Increasing forcing frequencies, Hz.
    force_shares : sequence of float
        Increasing factors of the machine's excitation.
    detunings : sequence of float
        Increasing shares by which the absorbers' springs are stiffer than designed.
    band : sequence of 2 floats, optional
        Lowest and highest frequency, Hz, over which the absorbers are tuned. If not given, all
        frequencies (`tuning.exact_absorber`); for the best, from the first to the last of
        `frequencies` (`direct.best_absorber`); so for both with `base_acceleration`.
    starts : int
        Random starts at each frequency and force share.
    seed : int

    Returns
    -------
    xarray.Dataset
        In SI units, over `competitor`, `detuning`, `frequency` and `force_share`: the largest
        displacements (mm) of the largest and of the smallest motion, how many stable periodic
        motions there are, the shares of starts that lead to the largest motion and that escape,
        and how the search for motions ended; over the force share the largest displacement between
        the first and the last frequency, sought between the frequencies too, and where it is; over
        `competitor` and `detuning` the stiffness, damping and cubic stiffness of the absorbers. The
        machine alone has the same values at all
        detunings. The attribute `remarks` says in words, keyed by competitor, why one is not
        possible.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it, in SI units.

    Examples
    --------
    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.05, force=40)
    >>> found = idm.absorber_responses(machine, "0.6 kg", [19, 20, 21])
    >>> found.competitor.values.tolist()
    ['bare', 'tuned', 'nonlinear', 'best']
    """
    mass = check_mass(machine, mass)
    frequencies, shares = check_grid(machine, frequencies, force_shares)
    detunings = _increasing("detunings", check_numbers("detunings", detunings, above=-1, most=10))
    if band is None and machine.base_acceleration is not None:
        band = frequencies[[0, -1]]
    band = None if band is None else check_band(machine, band)
    most = max(MOST_RUNS // (len(frequencies) * len(shares)), 1)
    why = f"with {len(frequencies)} frequencies and {len(shares)} force shares"
    check_count("starts", starts, least=1, most=most, why=why)
    check_count("seed", seed, **SEED_RANGE)
    absorbers, remarks = competitors(machine, mass, frequencies, band)
    found = _not_possible((len(COMPETITORS), len(detunings), len(frequencies), len(shares)))
    sizes = None
    for name, absorber in absorbers.items():
        row = COMPETITORS.index(name)
        for column, detuning in enumerate(detunings if absorber else [None]):
            # all detunings of the machine alone at once
            column = column if absorber else slice(None)
            built = absorber and absorber.detuned(detuning)
            values, sizes = _responses(machine, built, frequencies, shares, starts, seed, sizes)
            for key, value in values.items():
                found[key][row, column] = value
    scales = machine.scales
    coordinates = {
        "competitor": list(COMPETITORS),
        "detuning": detunings,
        "frequency": scales.from_si(frequencies, "frequency"),
        "force_share": shares,
    }
    parameters = {"absorber_mass": mass, "starts": starts, "seed": seed}
    if band is not None:
        parameters["band"] = band
    data = dataset(found, coordinates, parameters, "A machine without and with tuned absorbers")
    return in_si(data, machine).assign_attrs(remarks=json.dumps(remarks))


def competitors(machine, mass, frequencies, band=None):
    """Return the absorbers keyed by competitor, and remarks on those that are not possible.

    The absorber of the machine alone is None. Arguments as of `absorber_responses`.
    """
    absorbers, remarks = {"bare": None}, {}
    if machine.linear_stiffness == 0:
        remarks["tuned"] = remarks["nonlinear"] = (
            "not possible: the machine has no linear stiffness, so that its natural frequency "
            "depends on the amplitude and there is none to tune to"
        )
    else:
        absorbers["tuned"] = exact_absorber(machine, mass, band)
    if machine.cubic_stiffness == 0:
        remarks["nonlinear"] = remarks["best"] = (
            "not apart: on a machine with a linear spring it is the tuned absorber"
        )
        return absorbers, remarks
    if "tuned" in absorbers:
        absorbers["nonlinear"] = with_cubic(machine, absorbers["tuned"])
    if band is None and len(frequencies) == 1:
        remarks["best"] = "not possible: there is no band of frequencies"
    else:
        absorbers["best"] = best_absorber(machine, mass, band or frequencies[[0, -1]])
    return absorbers, remarks


def check_grid(machine, frequencies, force_shares):
    """Return frequencies and force shares as arrays, or raise an error that names what is wrong."""
    if not isinstance(machine, Machine):
        raise TypeError(f"machine = {shown(machine)}: must be a Machine")
    if machine.force == 0:
        raise ValueError("force = 0 N: must be greater than 0 N (without excitation all rests)")
    listed = frequencies if isinstance(frequencies, list | tuple) else np.atleast_1d(frequencies)
    checked = [machine.check_frequency(f"frequencies[{i}]", each) for i, each in enumerate(listed)]
    shares = check_numbers("force_shares", force_shares, above=0, most=1e6)
    return _increasing("frequencies", checked), _increasing("force_shares", shares)


def _responses(machine, absorber, frequencies, shares, starts, seed, sizes):
    """Return values over frequencies and shares, keyed by variable, and the sizes for `search`.

    The values are in the machine's scales.
    """
    scales, shape = machine.scales, (len(frequencies), len(shares))
    if machine.cubic_stiffness == 0 and (absorber is None or absorber.cubic_stiffness == 0):
        grid = scales.from_si(response(machine, absorber, frequencies), "displacement")
        most, one = np.outer(grid, shares), np.ones(shape)
        found = Search(most, most, one, one, 0 * one, flag("competitor_status", "found") * one)
        frequency, height = linear_peak(machine, absorber, frequencies)
        peak = scales.from_si(height, "displacement") * shares
    else:
        problems = problems_of(machine, absorber, frequencies, shares)
        found, orbits, sizes = search(problems, shape, starts, seed, sizes)
        found = Search(*(each.reshape(shape) for each in found))
        frequency, peak = orbit_peaks(machine, absorber, frequencies, shares, orbits)
        # a motion without a period, or of a longer one, may be larger
        place = np.where(np.isnan(found.most), -np.inf, found.most).argmax(axis=0)
        highest = found.most[place, np.arange(len(shares))]
        frequency = np.where(peak >= highest, frequency, frequencies[place])
        peak = np.fmax(peak, highest)
    values = {f"competitor_{NAMES[name]}": value for name, value in found._asdict().items()}
    values["competitor_peak"] = peak
    values["competitor_peak_frequency"] = scales.from_si(frequency, "frequency")
    if absorber is not None:
        values |= {
            f"absorber_{name}": scales.from_si(getattr(absorber, name), name) for name in SPRING
        }
    return values, sizes


def _not_possible(shape):
    """Return arrays for all competitors, filled as if none were possible."""
    found = {f"competitor_{name}": np.full(shape, np.nan) for name in NAMES.values()}
    found["competitor_motions"] = np.zeros(shape, int)
    found["competitor_status"] = np.full(shape, flag("competitor_status", "not_possible"))
    for name in PEAK:
        found[name] = np.full((*shape[:2], shape[3]), np.nan)
    return found | {f"absorber_{name}": np.full(shape[:2], np.nan) for name in SPRING}


def _increasing(name, values):
    values = np.asarray(values, float)
    if len(values) == 0 or np.any(np.diff(values) <= 0):
        raise ValueError(f"{name} = {shown(values.tolist())}: must be increasing, and at least one")
    return values
