"""Error against counted work: every method and model on a scene, at several settings.

The reference of a scene is a run in 80-bit arithmetic, by another program than any of those
compared. A chaotic motion has none that could be followed; there averages are compared, with their
standard errors, and those of the Taylor series over LONGER times as many periods at its tightest
setting are the reference; contacts count as missed or invented if their rate is off by
CONTACTS_OFF of it and SURE standard errors more.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.motions.simulate import COMPONENTS, check_state
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.rivals import averages, orbit_models, runs
from impact_damper.rivals.cheapest import SCIPY
from impact_damper.rivals.taylor_runs import name_of, taylor
from impact_damper.system.bounds import check_count
from impact_damper.system.packed import FREQUENCY
from impact_damper.system.parameters import describe, pack

ERRORS = ("amplitude", "state", "contact_time", "contacts")
AVERAGES = averages.STATISTICS
LONGER, SHORT = 4, 1
CONTACTS_OFF, SURE = 0.1, 2


class Scene(NamedTuple):
    """A motion on which methods are compared.

    Attributes
    ----------
    name : str
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
    state : sequence of float
        Z1, Z1', Z2, Z2' at W T = pi/2.
    periods : int
        Forcing periods of a run.
    motion : str
        "steady", an orbit as long as the forcing's period, which models of orbits are asked for as
        well; "transient"; or "chaotic".
    accuracy : dict
        `quantity`, of `ERRORS` or, chaotic, of `AVERAGES`, and `within` what error it is wanted.
    tolerance : float or None
        That of the Taylor series with which stages run motions like it, if any do.
    """

    name: str
    oscillator: object
    damper: object
    frequency: float
    state: object
    periods: int
    motion: str
    accuracy: dict
    tolerance: object = None

    @property
    def p(self):
        """Packed parameters."""
        return pack(self.oscillator, self.damper, self.frequency)


def check_accuracy(motion, accuracy):
    """Raise ValueError unless an accuracy is of quantities that a kind of motion has."""
    allowed = AVERAGES if motion == "chaotic" else ERRORS
    if accuracy["quantity"] not in allowed:
        raise ValueError(
            f"accuracy: quantity = {accuracy['quantity']!r}: must be one of {', '.join(allowed)} "
            f"for a {motion} motion"
        )


class Reference(NamedTuple):
    """What a run comes to in truth: as of `runs.Run`."""

    state: np.ndarray
    contact_times: np.ndarray
    displacement: float


def reference_of(scene, stored):
    """The reference of a scene from what is stored of it (`workflow/resources/references.json`).

    Raises
    ------
    ValueError
        If that belongs to another scene.
    """
    p, begin = scene.p, strobe_time(scene.p)
    end = begin + scene.periods * 2 * np.pi / p[FREQUENCY]
    given = [value if value is not None else np.inf for value in stored["parameters"]]
    same = np.array_equal(given, p) and stored["first"] == list(scene.state)
    if not same or abs(stored["end"] - end) > 1e-9:
        raise ValueError(
            "reference: belongs to other parameters, another start or another number of periods "
            "than the scene; it must be made anew (tests/extended/scenes.py)"
        )
    times = np.array([contact[1] for contact in stored["contacts"]])
    return Reference(np.array(stored["state"]), times, stored["amplitude"])


def error_against_work(scene, settings, stored=None):
    """Errors and counted work of each method on a scene.

    Parameters
    ----------
    scene : Scene
    settings : dict
        `taylor`, `merson`, `scipy`: decreasing tolerances; `orders`: further pairs of orders of the
        Taylor series, in flight and in contact; `evaluations`: those of the rate a
        forcing period at which a run of SciPy's methods is given up, by method; `harmonics`: the
        highest one; `batch`: forcing periods of a batch of a chaotic motion; `scipy_periods`:
        periods of a chaotic motion by SciPy's methods, which are slow.
    stored : dict or None
        The reference, which a chaotic scene does not need.

    Returns
    -------
    xarray.Dataset
        Over `run`: method, setting, status, work, and errors; or averages, if it is chaotic.

    Raises
    ------
    TypeError, ValueError
        If an argument is not of its kind or out of range.
    """
    check_count("periods", scene.periods)
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
    coordinates = {"component": list(COMPONENTS), "statistic": list(averages.STATISTICS)}
    return dataset(data, coordinates, made, "Error of methods against counted work")


def integrations(scene, settings, periods, scipy_periods):
    """Runs of all integrators: method, setting and run.

    Of a method that was capped, runs with tighter tolerances are left out; of a chaotic motion
    those of SciPy are run at the SHORT loosest ones.
    """
    p, start = scene.p, np.array(scene.state, float)
    begin = strobe_time(p)
    for tolerance in settings["taylor"]:
        yield "taylor", tolerance, taylor(p, start, begin, periods, tolerance)
        for orders in settings["orders"]:
            run = taylor(p, start, begin, periods, tolerance, tuple(orders))
            yield name_of(orders), tolerance, run
    if scene.motion != "steady" and scene.damper is not None:
        tolerance = min(settings["taylor"])
        restitution = scene.damper.restitution
        yield "rigid", tolerance, runs.rigid(p, restitution, start, begin, periods, tolerance)
    # without walls both are the same
    modes = {"kink": False, "located": True} if scene.damper is not None else {"kink": False}
    for name, locate in modes.items():
        for tolerance in settings["merson"]:
            run = runs.runge_kutta_merson(p, start, begin, periods, tolerance, locate)
            yield f"merson_{name}", tolerance, run
        for method in SCIPY:
            most = settings["evaluations"][method] * scipy_periods
            for tolerance in settings["scipy"][: SHORT if scene.motion == "chaotic" else None]:
                run = runs.scipy_run(
                    method, p, start, begin, scipy_periods, tolerance, locate, most
                )
                yield f"{method}_{name}", tolerance, run
                if run.status == "capped":
                    break


def _errors(scene, settings, reference):
    """Data of a scene that has a reference."""
    rows = [
        (method, setting, run, run.contact_times)
        for method, setting, run in integrations(scene, settings, scene.periods, scene.periods)
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
    if ended != "ended":
        return flag("run_status", ended)
    if wrong == 0:
        return flag("run_status", "ok")
    return flag("run_status", "missed_contacts" if wrong < 0 else "invented_contacts")


def _named(rows, status, met):
    return {
        "method": np.array([row[0] for row in rows]),
        "setting": np.array([row[1] for row in rows], float),
        "run_status": status,
        "operations": np.array([row[2].operations for row in rows], float),
        "meets_accuracy": met.astype(int),
    }


def _met(accuracy, errors):
    """Whether the accuracy is met; NaN is not."""
    return np.abs(errors[accuracy["quantity"]]) <= accuracy["within"]


def _orbits(scene, settings):
    """Models of the orbit of a steady scene: method, setting and model."""
    parts = scene.oscillator, scene.damper, scene.frequency
    state = np.array(scene.state, float)
    yield "rigid_balance", 1, orbit_models.rigid_balance(*parts, state)
    yield "full_balance", 1, orbit_models.full_balance(*parts, state)
    harmonics = orbit_models.many_harmonics(*parts, state, settings["harmonics"])
    for highest, model in harmonics.items():
        yield "many_harmonics", highest, model
    start = harmonics.get(orbit_models.START_HARMONICS)
    if start is not None and start.status == "ended":
        for name, model in orbit_models.rigid_impacts(*parts, start).items():
            yield name, orbit_models.POLISH_TOLERANCE, model
        yield "shooting", orbit_models.POLISH_TOLERANCE, orbit_models.shooting(*parts, start)


def _times(scene, model, reference):
    """When contacts of an orbit begin in the run, those of the reference's beginning included."""
    p, period = scene.p, 2 * np.pi / scene.frequency
    count = len(reference.contact_times) // scene.periods
    if len(model.contact_phases) != count or count == 0:
        return np.empty(len(model.contact_phases) * scene.periods)
    # each contact is set beside the nearest one of the reference's last period
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
    """Batches of the exponent by the methods that have variational equations."""
    given = scene.p, np.array(scene.state, float), tolerance, scene.periods, batch
    if method == "taylor":
        return {"exponent": averages.exponents(*given)}
    if method == "rigid":
        return {"exponent": averages.rigid_exponents(scene.damper.restitution, *given)}
    return {}


def _averages(scene, settings):
    """Data of a chaotic scene."""
    p, start = scene.p, np.array(scene.state, float)
    batch, begin = settings["batch"], strobe_time(scene.p)
    rows, found = [], []
    short = min(settings["scipy_periods"], scene.periods)
    for method, setting, run in integrations(scene, settings, scene.periods, short):
        periods = short if method.split("_")[0] in SCIPY else scene.periods
        measured = {}
        if run.status == "ended":
            measured = averages.of_run(p, run, begin, periods, batch)
            measured |= _exponent(scene, method, setting, batch)
        run = run._replace(operations=run.operations * scene.periods / periods)
        rows.append((method, setting, run))
        found.append(averages.estimates(measured))
    tightest, long = min(settings["taylor"]), LONGER * scene.periods
    run = taylor(p, start, begin, long, tightest)
    measured = averages.of_run(p, run, begin, long, batch)
    measured["exponent"] = averages.exponents(p, start, tightest, long, batch)
    truth, truth_error = averages.estimates(measured)
    average, error = np.array(found).transpose(1, 0, 2)
    relative = dict(zip(averages.STATISTICS, (average / truth - 1).T, strict=True))
    # contacts are missed or invented beyond doubt alone
    borne = CONTACTS_OFF + SURE * error[:, 0] / truth[0]
    excess = np.where(np.abs(relative["contact_rate"]) > borne, relative["contact_rate"], 0)
    status = [_status(row[2].status, wrong) for row, wrong in zip(rows, excess, strict=True)]
    return _named(rows, status, _met(scene.accuracy, relative)) | {
        "average": average,
        "average_error": error,
        "reference_average": truth,
        "reference_average_error": truth_error,
    }
