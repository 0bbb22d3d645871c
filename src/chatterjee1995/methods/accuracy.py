"""Error and counted work of every method and model on a test case (scene), at several settings.

A method is an integrator, a model solves for a periodic motion directly (`rivals.orbit_models`).
The reference is a run in 80-bit arithmetic by an independent program. Work is counted in
floating-point operations. No method can follow a chaotic motion to its end. For such a motion
averages are compared, with their standard errors. The reference is then a longer run of the Taylor
series, the integrator of this package, at its tightest tolerance. A method misses or invents
contacts of a chaotic motion if its number of contacts per cycle differs too much from the number of
the reference (CONTACTS_OFF, SURE).
"""

import numpy as np

from chatterjee1995.methods import averages, orbit_models
from chatterjee1995.methods.comparison_scenes import check_accuracy, reference_of
from chatterjee1995.methods.methods import (
    COMPARED,
    METHODS,
    START_HARMONICS,
    STATISTICS,
    integrators,
    name_and_mode,
)
from chatterjee1995.methods.taylor_runs import name_of, taylor
from impact_damper.data.datasets import dataset, flag
from impact_damper.model.bounds import PERIODS_RANGE, check_count
from impact_damper.model.packed import FREQUENCY
from impact_damper.model.parameters import describe
from impact_damper.motions.simulate import COMPONENTS, check_state
from impact_damper.motions.strobe_map import strobe_time

# Length of the reference run of a chaotic motion, divided by the length of the compared runs.
LONGER = 4
# Slow integrators (`methods.Method.slow`) run a chaotic motion only with their SHORT loosest
# tolerances.
SHORT = 1
# The number of contacts per cycle of a chaotic motion is right if it differs from the number of the
# reference by at most the fraction CONTACTS_OFF plus SURE standard errors of the compared run.
CONTACTS_OFF, SURE = 0.1, 2


def error_against_work(scene, settings, stored=None):
    """Return errors and counted work of each method on a test case (scene).

    Parameters
    ----------
    scene : ComparisonScene
    settings : dict
        For each key of `methods.TOLERANCE_KEYS` a list of decreasing tolerances; `orders`: further
        pairs of orders of the Taylor series, in flight and in contact; `evaluations`: for each name
        in `methods.LIMITED`, the number of evaluations of the right-hand side per forcing cycle
        after which a run is given up; `harmonics`: highest harmonic of harmonic balance; `batch`:
        number of forcing cycles in a batch (standard errors follow from the averages of batches);
        `scipy_periods`: forcing cycles for which slow integrators run a chaotic motion.
    stored : dict or None
        Stored reference of this test case (`reference_of`); not needed if the motion is chaotic.

    Returns
    -------
    xarray.Dataset
        For each `run`: method, setting, status, work, and errors, or averages if the motion is
        chaotic.

    Raises
    ------
    TypeError, ValueError
        If an argument is not of its kind or out of range.
    """
    check_count("periods", scene.periods, **PERIODS_RANGE)
    check_state(scene.state, scene.damper)
    check_accuracy(scene.motion, scene.accuracy)
    if scene.motion == "chaotic":
        data = _averages(scene, settings)
    else:
        if stored is None:
            raise ValueError("stored: a motion that is not chaotic needs its reference")
        data = _errors(scene, settings, reference_of(scene, stored))
    made = describe(scene.oscillator, scene.damper) | {
        "scene": scene.name,
        "frequency": scene.frequency,
        "periods": scene.periods,
        "motion": scene.motion,
        "accuracy": scene.accuracy,
        "tolerance": scene.tolerance,
    }
    coordinates = {"component": list(COMPONENTS), "statistic": list(STATISTICS)}
    return dataset(data, coordinates, made, "Error of methods against counted work")


def integrations(scene, settings, slow_periods):
    """Run each integrator at each setting.

    Slow integrators run for `slow_periods` forcing cycles, and only with their loosest tolerances
    (SHORT) if the motion is chaotic. Once a slow run is given up, tighter tolerances are left out.

    Yields
    ------
    label : str
        Label of the integrator (`methods.COMPARED`).
    setting : float
        Tolerance.
    run : rivals.runs.Run
    periods : int
        Forcing cycles of the run.
    """
    p, start = scene.p, np.array(scene.state, float)
    given = p, start, strobe_time(p), scene.periods
    for tolerance in settings["taylor"]:
        yield "taylor", tolerance, taylor(*given, tolerance), scene.periods
        for orders in settings["orders"]:
            run = taylor(*given, tolerance, tuple(orders))
            yield name_of(orders), tolerance, run, scene.periods
    if scene.motion != "steady" and scene.damper is not None:
        tolerance, restitution = min(settings["taylor"]), scene.damper.restitution
        run = orbit_models.rigid(p, restitution, *given[1:], tolerance)
        yield "rigid", tolerance, run, scene.periods
    rivals = [(label, *name_and_mode(label)) for label in COMPARED["accuracy"] if label != "taylor"]
    # Without a damper there are no contacts to locate, and both modes are the same.
    for mode in (False, True) if scene.damper is not None else (False,):
        for label, name, locate in rivals:
            if locate == mode:
                yield from _at_tolerances(label, name, locate, scene, settings, slow_periods)


def _at_tolerances(label, name, locate, scene, settings, slow_periods):
    """Yield what `integrations` yields, for one integrator in one mode, at each tolerance."""
    method, integrator = METHODS[name], integrators()[name]
    tolerances, periods, most = settings[method.tolerances], scene.periods, None
    if method.slow:
        periods, most = slow_periods, settings["evaluations"][name] * slow_periods
        tolerances = tolerances[: SHORT if scene.motion == "chaotic" else None]
    given = scene.p, np.array(scene.state, float), strobe_time(scene.p), periods
    for tolerance in tolerances:
        run = integrator.run(*given, tolerance, locate, most)
        yield label, tolerance, run, periods
        if run.status == "capped":
            break


def _errors(scene, settings, reference):
    """Return the variables of the dataset for a test case that has a reference."""
    rows = [
        (label, setting, run, run.contact_times)
        for label, setting, run, _ in integrations(scene, settings, scene.periods)
    ]
    orbits = _orbits(scene, settings) if scene.motion == "steady" else []
    rows += [
        (method, setting, model, _times(scene, model, reference))
        for method, setting, model in orbits
    ]
    data = {name: [] for name in ("state", "contact_time", "contacts", "amplitude", "status")}
    for _, _, found, times in rows:
        wrong = len(times) - len(reference.contact_times)
        ended = found.status == "ended"
        away = np.abs(times - reference.contact_times) if wrong == 0 else np.full(1, np.nan)
        data["state"].append(np.max(np.abs(found.state - reference.state)))
        data["contact_time"].append(np.max(away, initial=0.0))
        data["contacts"].append(wrong if ended else np.nan)
        data["amplitude"].append(abs(found.displacement / reference.displacement - 1))
        data["status"].append(_status(found.status, wrong))
    errors = {name: np.array(data[name]) for name in data}
    met = _met(scene.accuracy, errors) & ~np.isnan(errors["state"])
    return _named(rows, errors["status"], met) | {
        "state_error": errors["state"],
        "contact_time_error": np.where(np.isnan(errors["state"]), np.nan, errors["contact_time"]),
        "contact_excess": errors["contacts"],
        "amplitude_error": errors["amplitude"],
        "reference_state": reference.state,
        "reference_contacts": len(reference.contact_times),
        "reference_amplitude": reference.displacement,
    }


def _status(ended, wrong):
    """Return the flag `run_status`, from how a run ended and its excess number of contacts."""
    if ended != "ended":
        return flag("run_status", ended)
    if wrong == 0:
        return flag("run_status", "ok")
    return flag("run_status", "missed_contacts" if wrong < 0 else "invented_contacts")


def _named(rows, status, met):
    """Return the variables of the dataset that all kinds of test cases have."""
    return {
        "method": np.array([row[0] for row in rows]),
        "setting": np.array([row[1] for row in rows], float),
        "run_status": status,
        "operations": np.array([row[2].operations for row in rows], float),
        "meets_accuracy": met.astype(int),
    }


def _met(accuracy, errors):
    """Return whether each error is within the required accuracy; False for NaN."""
    return np.abs(errors[accuracy["quantity"]]) <= accuracy["within"]


def _orbits(scene, settings):
    """Yield the label, the setting and the result of each model of a steady motion."""
    parts = scene.oscillator, scene.damper, scene.frequency
    state = np.array(scene.state, float)
    yield "rigid_balance", 1, orbit_models.rigid_balance(*parts, state)
    yield "full_balance", 1, orbit_models.full_balance(*parts, state)
    harmonics = orbit_models.many_harmonics(*parts, state, settings["harmonics"])
    for highest, model in harmonics.items():
        yield "many_harmonics", highest, model
    start = harmonics.get(START_HARMONICS)
    if start is not None and start.status == "ended":
        for name, model in orbit_models.rigid_impacts(*parts, start).items():
            yield name, orbit_models.POLISH_TOLERANCE, model
        yield "shooting", orbit_models.POLISH_TOLERANCE, orbit_models.shooting(*parts, start)


def _times(scene, model, reference):
    """Return the times at which contacts begin by a model, for all cycles of the reference run.

    A model computes one cycle only, while the reference approaches the periodic motion. Each
    contact in the last cycle of the reference is matched to the nearest contact of the model. The
    difference of their times is added to the corresponding contacts of the reference in all cycles.
    The times are NaN if two contacts of the reference have the same match. If the model has another
    number of contacts per cycle, only the length of the result has a meaning.
    """
    p, period = scene.p, 2 * np.pi / scene.frequency
    count = len(reference.contact_times) // scene.periods
    if len(model.contact_phases) != count or count == 0:
        return np.empty(len(model.contact_phases) * scene.periods)
    last = reference.contact_times[-count:]
    found = model.contact_phases / p[FREQUENCY]
    turns = np.round((last[:, None] - found) / period)
    away = np.abs(last[:, None] - found - turns * period)
    nearest = np.argmin(away, axis=1)
    if len(set(nearest)) < count:
        return np.full(len(reference.contact_times), np.nan)
    shift = found[nearest] + turns[np.arange(count), nearest] * period - last
    return reference.contact_times + np.tile(shift, scene.periods)


def _exponent(scene, method, tolerance, batch):
    """Return the Lyapunov exponent in each batch, or {} without variational equations."""
    given = scene.p, np.array(scene.state, float), tolerance, scene.periods, batch
    if method == "taylor":
        return {"exponent": averages.exponents(*given)}
    if method == "rigid":
        return {"exponent": averages.rigid_exponents(scene.damper.restitution, *given)}
    return {}


def _averages(scene, settings):
    """Return the variables of the dataset for a test case with a chaotic motion."""
    p, start = scene.p, np.array(scene.state, float)
    batch, begin = settings["batch"], strobe_time(scene.p)
    rows, found = [], []
    short = min(settings["scipy_periods"], scene.periods)
    for label, setting, run, periods in integrations(scene, settings, short):
        measured = {}
        if run.status == "ended":
            measured = averages.of_run(p, run, begin, periods, batch)
            measured |= _exponent(scene, label, setting, batch)
        run = run._replace(operations=run.operations * scene.periods / periods)
        rows.append((label, setting, run))
        found.append(averages.estimates(measured))
    tightest, long = min(settings["taylor"]), LONGER * scene.periods
    run = taylor(p, start, begin, long, tightest)
    measured = averages.of_run(p, run, begin, long, batch)
    measured["exponent"] = averages.exponents(p, start, tightest, long, batch)
    truth, truth_error = averages.estimates(measured)
    average, error = np.array(found).transpose(1, 0, 2)
    relative = dict(zip(STATISTICS, (average / truth - 1).T, strict=True))
    allowed = CONTACTS_OFF + SURE * error[:, 0] / truth[0]
    excess = np.where(np.abs(relative["contact_rate"]) > allowed, relative["contact_rate"], 0)
    status = [_status(row[2].status, wrong) for row, wrong in zip(rows, excess, strict=True)]
    return _named(rows, status, _met(scene.accuracy, relative)) | {
        "average": average,
        "average_error": error,
        "reference_average": truth,
        "reference_average_error": truth_error,
    }
