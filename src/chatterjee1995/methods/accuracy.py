"""Errors and numbers of operations of integrators and models, on test motions called scenes."""

from typing import NamedTuple

import numpy as np

from chatterjee1995.methods import averages, orbit_models
from chatterjee1995.methods.integrators import runs_of_accuracy
from chatterjee1995.methods.integrators.taylor import taylor
from chatterjee1995.methods.labels import ERRORS, START_HARMONICS, STATISTICS
from impact_damper.data.datasets import dataset, flag
from impact_damper.data.variables import register
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator, describe, pick
from impact_damper.motions.simulate import COMPONENTS
from impact_damper.motions.strobe_map import strobe_time

register(
    """
method | run | | | integrator or model
setting | run | | | tolerance of the integrator, or highest harmonic of a harmonic balance
run_status | run | | | end of the run; missed_contacts: fewer contacts than the reference,
  invented_contacts: more contacts
  : ok 0, missed_contacts 1, invented_contacts 2, failed 3, capped 4, not_applicable 5
operations | run | | | floating-point operations of an integrator's run, or of a model's search
  for the orbit; an elementary function counts as 20
state_error | run | | | largest error of a component of the state at the end of the run
contact_time_error | run | | T | largest error of the time at which a contact begins; NaN if the
  number of contacts is wrong
contact_excess | run | | | number of contacts minus the number in the reference
amplitude_error | run | | | relative error of max |Z1|
statistic | statistic | | | name of an average over a chaotic motion
average | run statistic | | | average: contacts per cycle, max |Z1| in a cycle, or largest
  Lyapunov exponent
average_error | run statistic | | | standard error of the average, from its values in batches of
  cycles
reference_average | statistic | | | average in the reference
reference_average_error | statistic | | | standard error of the average in the reference
meets_accuracy | run | | | whether the run meets the accuracy required by the scene
  : no 0, yes 1
    """
)

LONGER = 4  # the reference run of a chaotic scene is LONGER times as long as the scene
# In a chaotic motion the number of contacts per cycle counts as wrong if its relative error exceeds
# CONTACTS_OFF plus SURE standard errors.
CONTACTS_OFF, SURE = 0.1, 2


class ComparisonScene(NamedTuple):
    """A test motion that begins with `state` at W T = pi/2. `motion` names its kind."""

    oscillator: Oscillator
    damper: Damper | None
    frequency: float
    state: list
    periods: int
    motion: str
    accuracy: dict

    @property
    def p(self):
        """The packed parameters of the scene, which kernels read."""
        return pack(self.oscillator, self.damper, self.frequency)


class Reference(NamedTuple):
    """Last state, contact times and max |Z1| from 80-bit arithmetic. They count as exact."""

    state: np.ndarray
    contact_times: np.ndarray
    displacement: float


def reference_of(scene, stored):
    """Return the `Reference` of a scene from `stored`, an entry of `resources/references.json`."""
    p, begin = scene.p, strobe_time(scene.p)
    end = begin + scene.periods * 2 * np.pi / p[FREQUENCY]
    values = stored["parameters"]
    damper = Damper(**pick(Damper, values)) if "mass_ratio" in values else None
    system = pack(Oscillator(**pick(Oscillator, values)), damper, values["frequency"])
    same = np.array_equal(system, p) and stored["first"] == list(scene.state)
    if not same or abs(stored["end"] - end) > 1e-9:
        raise ValueError(
            "reference: belongs to other parameters, another start or another number of cycles "
            "than the scene; compute it again (tests/references/extended/scenes.py)"
        )
    times = np.array(stored["contact_times"])
    return Reference(np.array(stored["state"]), times, stored["amplitude"])


def accuracy(system, damper, *, name, settings, references, **given):
    """Return a dataset: errors and operations of integrators and models on the scene `name`.

    `settings` is the section `comparison` of the configuration. `references` is the content of
    `resources/references.json`. `given` holds the other fields of a `ComparisonScene`.
    """
    scene = ComparisonScene(oscillator=system, damper=damper, **given)
    if scene.motion == "chaotic":
        data = _averages(scene, settings)
    else:
        data = _errors(scene, settings, reference_of(scene, references[name]))
    made = describe(system, damper) | given | {"scene": name}
    del made["state"]
    coordinates = {"component": list(COMPONENTS), "statistic": list(STATISTICS)}
    return dataset(data, coordinates, made, "Error of methods against work")


def _integrations(scene, settings, slow_periods):
    p, start = scene.p, np.array(scene.state, float)
    given = p, start, strobe_time(p), scene.periods
    for tolerance in settings["taylor"]:
        for orders in settings["orders"]:
            run = taylor(*given, tolerance, tuple(orders))
            yield "taylor_{}_{}".format(*orders), tolerance, run, scene.periods
    if scene.motion != "steady" and scene.damper is not None:
        tolerance, restitution = min(settings["taylor"]), scene.damper.restitution
        run = orbit_models.rigid(p, restitution, *given[1:], tolerance)
        yield "rigid", tolerance, run, scene.periods
    for label, (integrator, locate) in runs_of_accuracy().items():
        # Without a damper there are no contacts to locate: the run with `locate` false is enough.
        if scene.damper is None and locate and False in integrator.located:
            continue
        tolerances, periods, most = settings[integrator.tolerances], scene.periods, None
        if integrator.slow:
            periods, most = slow_periods, settings["evaluations"] * slow_periods
            tolerances = tolerances[: 1 if scene.motion == "chaotic" else None]
        for tolerance in tolerances:
            run = integrator.run(*given[:3], periods, tolerance, locate, most)
            yield label, tolerance, run, periods
            if run.status == "capped":
                break


def _errors(scene, settings, reference):
    rows = [
        (label, setting, run, run.contact_times)
        for label, setting, run, _ in _integrations(scene, settings, scene.periods)
    ]
    orbits = _orbits(scene, settings) if scene.motion == "steady" else []
    rows += [(*orbit, _times(scene, orbit[-1], reference)) for orbit in orbits]
    status, errors = [], []
    for _, _, found, times in rows:
        wrong = len(times) - len(reference.contact_times)
        away = np.abs(times - reference.contact_times) if wrong == 0 else np.full(1, np.nan)
        ended = found.status == "ended"
        status.append(_status(found.status, wrong))
        size = abs(found.displacement / reference.displacement - 1)
        state = np.max(np.abs(found.state - reference.state))
        latest = np.max(away, initial=0.0) if ended else np.nan
        errors.append((size, state, latest, wrong if ended else np.nan))
    errors = np.array(errors, float).T
    names = "amplitude_error", "state_error", "contact_time_error", "contact_excess"
    judged = dict(zip(ERRORS, errors, strict=True))
    return _named(scene, rows, status, judged) | dict(zip(names, errors, strict=True))


def _status(ended, wrong):
    if ended != "ended":
        return flag("run_status", ended)
    if wrong == 0:
        return flag("run_status", "ok")
    return flag("run_status", "missed_contacts" if wrong < 0 else "invented_contacts")


def _named(scene, rows, status, errors):
    met = np.abs(errors[scene.accuracy["quantity"]]) <= scene.accuracy["within"]
    return {
        "method": np.array([row[0] for row in rows]),
        "setting": np.array([row[1] for row in rows], float),
        "run_status": np.array(status),
        "operations": np.array([row[2].operations for row in rows], float),
        "meets_accuracy": met.astype(int),
    }


def _orbits(scene, settings):
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
    p, period = scene.p, 2 * np.pi / scene.frequency
    count = len(reference.contact_times) // scene.periods
    if len(model.contact_phases) != count or count == 0:
        return np.full(len(model.contact_phases) * scene.periods, np.nan)
    last = reference.contact_times[-count:]
    found = model.contact_phases / p[FREQUENCY]
    turns = np.round((last[:, None] - found) / period)
    away = np.abs(last[:, None] - found - turns * period)
    nearest = np.argmin(away, axis=1)
    if len(set(nearest)) < count:
        return np.full(len(reference.contact_times), np.nan)
    shift = found[nearest] + turns[np.arange(count), nearest] * period - last
    return reference.contact_times + np.tile(shift, scene.periods)


def _averages(scene, settings):
    p, start = scene.p, np.array(scene.state, float)
    batch, begin = settings["batch"], strobe_time(scene.p)
    rows, found = [], []
    short = min(settings["scipy_periods"], scene.periods)
    for label, setting, run, periods in _integrations(scene, settings, short):
        measured = {}
        if run.status == "ended":
            measured = averages.of_run(p, run, begin, periods, batch)
            if label in ("taylor", "rigid"):  # only these integrate the variational equations
                restitution = scene.damper.restitution if label == "rigid" else None
                given = p, start, setting, scene.periods, batch, restitution
                measured["exponent"] = averages.exponents(*given)
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
    return _named(scene, rows, status, relative) | {
        "average": average,
        "average_error": error,
        "reference_average": truth,
        "reference_average_error": truth_error,
    }
