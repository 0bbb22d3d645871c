"""Displacements of a machine with absorbers that could be built in place of an impact damper.

`absorber_responses` compares four competitors for one machine and one added mass, over forcing
frequencies and forcing amplitudes. The stiffness of each absorber is as designed, and detuned.

    bare        the machine alone
    tuned       the absorber tuned exactly to the machine, with a linear spring
    nonlinear   the tuned absorber with an additional cubic spring that keeps the peaks equal
    best        the absorber that minimises the largest displacement at the machine's own force
"""

import json

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.data.results import in_si
from impact_damper.design.absorber import check_mass
from impact_damper.design.absorber_problems import problems_of
from impact_damper.design.absorber_search import Search, search
from impact_damper.design.direct import best_absorber
from impact_damper.design.linear_response import response
from impact_damper.design.peaks import linear_peak, orbit_peaks
from impact_damper.design.tuning import check_band, exact_absorber, with_cubic
from impact_damper.model.bounds import MOST_RUNS, SEED_RANGE, check_count, shown
from impact_damper.model.checks import check_numbers
from impact_damper.model.machine import Machine

COMPETITORS = ("bare", "tuned", "nonlinear", "best")
# Force shares: factors of the machine's excitation, from a quarter to four.
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
    orbits, and runs from random starts find motions that the search for orbits missed.

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
        Increasing relative changes of the absorbers' stiffnesses; 0.1 is 10 per cent stiffer than
        designed.
    band : sequence of 2 floats, optional
        Lowest and highest frequency, Hz, over which the absorbers are tuned. By default the tuned
        absorber is tuned over all frequencies (`tuning.exact_absorber`), and the best absorber from
        the first to the last of `frequencies` (`direct.best_absorber`). For a machine with
        `base_acceleration` the default for both is from the first to the last of `frequencies`.
    starts : int
        Number of random starts at each frequency and force share.
    seed : int

    Returns
    -------
    xarray.Dataset
        In SI units.

        - Over `competitor`, `detuning`, `frequency` and `force_share`: the largest displacements
          (mm) of the largest and of the smallest motion, the number of stable periodic motions, the
          shares of starts that lead to the largest motion and that escape, and the status of the
          search for motions.
        - Over `competitor`, `detuning` and `force_share`: the largest displacement from the first
          to the last frequency, also between the given frequencies, and its frequency.
        - Over `competitor` and `detuning`: stiffness, damping and cubic stiffness of the absorbers.

        The machine alone has the same values at all detunings. The attribute `remarks` (JSON) maps
        each competitor that is not possible to the reason.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it, in SI units.

    Examples
    --------
    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.05, force=40)
    >>> responses = idm.absorber_responses(machine, "0.6 kg", [19, 20, 21])
    >>> responses.competitor.values.tolist()
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
    table = _not_possible((len(COMPETITORS), len(detunings), len(frequencies), len(shares)))
    sizes = None
    for name, absorber in absorbers.items():
        row = COMPETITORS.index(name)
        for column, detuning in enumerate(detunings if absorber else [None]):
            # The machine alone has no detuning, so its values are written to all columns.
            column = column if absorber else slice(None)
            built = absorber and absorber.detuned(detuning)
            values, sizes = _responses(machine, built, frequencies, shares, starts, seed, sizes)
            for key, value in values.items():
                table[key][row, column] = value
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
    data = dataset(table, coordinates, parameters, "A machine without and with tuned absorbers")
    return in_si(data, machine).assign_attrs(remarks=json.dumps(remarks))


def competitors(machine, mass, frequencies, band=None):
    """Return the absorbers keyed by competitor, and remarks on those that are not possible.

    The absorber of the competitor "bare", the machine alone, is None. The arguments are as in
    `absorber_responses`.
    """
    absorbers, remarks = {"bare": None}, {}
    if machine.linear_stiffness == 0:
        remarks["tuned"] = remarks["nonlinear"] = (
            "not possible: the machine has no linear stiffness, so its natural frequency depends "
            "on the amplitude, and an absorber cannot be tuned to it"
        )
    else:
        absorbers["tuned"] = exact_absorber(machine, mass, band)
    if machine.cubic_stiffness == 0:
        remarks["nonlinear"] = remarks["best"] = (
            "not listed separately: on a machine with a linear spring it is the tuned absorber"
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
    """Return frequencies and force shares as arrays.

    Raises
    ------
    TypeError, ValueError
        If an argument is not allowed; the message names it.
    """
    if not isinstance(machine, Machine):
        raise TypeError(f"machine = {shown(machine)}: must be a Machine")
    if machine.force == 0:
        raise ValueError("force = 0 N: must be greater than 0 N (without excitation nothing moves)")
    listed = frequencies if isinstance(frequencies, list | tuple) else np.atleast_1d(frequencies)
    checked = [machine.check_frequency(f"frequencies[{i}]", each) for i, each in enumerate(listed)]
    shares = check_numbers("force_shares", force_shares, above=0, most=1e6)
    return _increasing("frequencies", checked), _increasing("force_shares", shares)


def _responses(machine, absorber, frequencies, shares, starts, seed, sizes):
    """Return the values of one competitor, keyed by variable, and the argument `sizes` of `search`.

    The values, over frequencies and force shares, are in the machine's scales.
    """
    scales, shape = machine.scales, (len(frequencies), len(shares))
    if machine.cubic_stiffness == 0 and (absorber is None or absorber.cubic_stiffness == 0):
        grid = scales.from_si(response(machine, absorber, frequencies), "displacement")
        most, one = np.outer(grid, shares), np.ones(shape)
        motions = Search(most, most, one, one, 0 * one, flag("competitor_status", "found") * one)
        frequency, height = linear_peak(machine, absorber, frequencies)
        peak = scales.from_si(height, "displacement") * shares
    else:
        problems = problems_of(machine, absorber, frequencies, shares)
        motions, orbits, sizes = search(problems, shape, starts, seed, sizes)
        motions = Search(*(each.reshape(shape) for each in motions))
        frequency, peak = orbit_peaks(machine, absorber, frequencies, shares, orbits)
        # A motion that is not periodic, or has a period above 1, may be larger.
        place = np.where(np.isnan(motions.most), -np.inf, motions.most).argmax(axis=0)
        highest = motions.most[place, np.arange(len(shares))]
        frequency = np.where(peak >= highest, frequency, frequencies[place])
        peak = np.fmax(peak, highest)
    values = {f"competitor_{NAMES[name]}": value for name, value in motions._asdict().items()}
    values["competitor_peak"] = peak
    values["competitor_peak_frequency"] = scales.from_si(frequency, "frequency")
    if absorber is not None:
        values |= {
            f"absorber_{name}": scales.from_si(getattr(absorber, name), name) for name in SPRING
        }
    return values, sizes


def _not_possible(shape):
    """Return arrays for all competitors with the values of a competitor that is not possible."""
    table = {f"competitor_{name}": np.full(shape, np.nan) for name in NAMES.values()}
    table["competitor_motions"] = np.zeros(shape, int)
    table["competitor_status"] = np.full(shape, flag("competitor_status", "not_possible"))
    for name in PEAK:
        table[name] = np.full((*shape[:2], shape[3]), np.nan)
    return table | {f"absorber_{name}": np.full(shape[:2], np.nan) for name in SPRING}


def _increasing(name, values):
    values = np.asarray(values, float)
    if len(values) == 0 or np.any(np.diff(values) <= 0):
        raise ValueError(
            f"{name} = {shown(values.tolist())}: must be increasing, and at least one value"
        )
    return values
