"""Design or evaluation of a damper for a machine and a band of frequencies."""

import hashlib
import json
from pathlib import Path

import xarray as xr

from impact_damper.data.datasets import SOURCE, flag, load, save
from impact_damper.data.whole_files import BrokenFileError
from impact_damper.design.additions import ADDITIONS
from impact_damper.design.confirm import evaluate_gap, find_gap
from impact_damper.design.task import NUMERICAL, TOLERANCES, Effort, Task, labelled
from impact_damper.model.arguments import read_system
from impact_damper.model.bounds import names_arguments, shown
from impact_damper.model.machine import Machine, describe_si


@names_arguments
def design_damper(
    machine,
    *,
    mass,
    band,
    restitution,
    contact,
    mount=None,
    tolerances=None,
    displacement_limit=None,
    share=0.95,
    absorber=None,
    effort=None,
    folder=None,
    progress=False,
):
    """Find the gap with which a machine moves least, and say how far the machine moves.

    A start is a random initial state. The promised displacement of a gap is a bound: the motions
    from at least the fraction `share` of all starts stay below the bound, with 95 % confidence. The
    bound holds at each frequency of the band and for the worst values within the tolerances. The
    chosen gap is confirmed with starts that the search has not used.

    Parameters
    ----------
    machine : Machine
    mass : float or str
        Loose mass, kg, at most the mass of the machine. Each physical value is a number in SI
        units, a text with a unit such as "0.6 kg", or a quantity of pint.
    band : sequence of 2 floats or str
        Least and greatest forcing frequency, Hz. The machine must resonate in a part of the band.
    restitution : float
        Coefficient of restitution, 0.05 to 1.
    contact : float, str or HertzContact
        Stiffness of the contact, N/m, or the contact of curved bodies. The stiffness of curved
        bodies depends on the speed of impact. The speed is assumed to be 2 f g: f is the middle
        frequency of the band, g the gap by the paper's rule (18) at f.
    mount : dict, optional
        Arguments of `impact_damper.model.machine.mounting`, such as {"inclination": "90 deg"} or
        {"friction_coefficient": 0.1}. By default the gap is horizontal and without friction.
    tolerances : dict, optional
        Largest deviations of gap, contact_stiffness, stiffness, damping, force, restitution,
        gravity and friction. A deviation is relative, such as {"gap": "10 %"}. The first five may
        have a unit instead, such as {"gap": "0.2 mm"}. The default is {"gap": "20 %"}.
    displacement_limit : float or str, optional
        Largest allowed displacement, m. The promised displacement is compared with this limit.
    share : float
        Fraction of all starts for which the promised displacement holds, 0.5 to 0.999.
    absorber : dict, optional
        Absorber of your own: `mass` (kg), `stiffness` (N/m) and `damping` (N s/m). The damper is
        compared with this absorber, and in any case with a tuned absorber.
    effort : Effort, optional
        How many frequencies, gaps and starts are computed, and with how many threads.
    folder : str or pathlib.Path, optional
        Folder for results of finished steps. An interrupted design continues from these results.
    progress : bool
        Whether progress bars are shown.

    Returns
    -------
    xarray.Dataset
        The attribute `units` of a variable is its unit, such as mm, Hz or N. `design_gap` is the
        gap, `promised_displacement` the bound. `decision` is a number that `decode` translates.
        `plot.conclusion` gives the result in sentences, and `plot.design` draws the result.

    Raises
    ------
    TypeError, ValueError
        If an argument has a wrong type or is out of range. The message names argument and value.

    Examples
    --------
    A share of 95 % at 95 % confidence needs at least 59 starts:

    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    >>> damper = {"mass": "1.2 kg", "restitution": 0.6, "contact": 2e7}
    >>> idm.design_damper(
    ...     machine, **damper, band=(20, 21), effort=idm.Effort(starts=20)
    ... )  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ValueError: starts = 20: must be from 59 to ...
    """
    task = Task(
        machine=machine,
        mass=mass,
        band=band,
        restitution=restitution,
        contact=contact,
        mount=mount,
        tolerances=TOLERANCES if tolerances is None else tolerances,
        displacement_limit=displacement_limit,
        share=share,
        absorber=absorber,
        effort=Effort() if effort is None else effort,
    )
    return answer(task, find_gap, "Design of an impact damper for a machine", folder, progress)


@names_arguments
def evaluate_damper(
    machine,
    damper,
    *,
    band,
    tolerances=None,
    displacement_limit=None,
    share=0.95,
    absorber=None,
    effort=None,
    folder=None,
    progress=False,
):
    """Find the promised displacement of a machine with an existing damper.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
        A result of `Machine.damper`.
    band, tolerances, displacement_limit, share, absorber, effort, folder, progress
        See `design_damper`.

    Returns
    -------
    xarray.Dataset
        See `design_damper`.

    Raises
    ------
    TypeError, ValueError
        If an argument has a wrong type or is out of range. The message names argument and value.

    Examples
    --------
    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    >>> made = {"mass": 1.2, "restitution": 0.6, "contact_stiffness": 2e7}
    >>> damper = machine.damper(gap="3.8 mm", **made)
    >>> found = idm.evaluate_damper(machine, damper, band=(20, 21))  # doctest: +SKIP
    """
    if not isinstance(machine, Machine):
        raise TypeError(f"machine = {shown(machine)}: must be a Machine")
    read_system(machine, damper, needs_damper=True)
    task = Task(
        machine=machine,
        mass=damper.mass,
        band=band,
        restitution=damper.restitution,
        contact=damper.contact_stiffness,
        gap=damper.gap,
        mount={"gravity": damper.gravity, "friction": damper.friction},
        exit_rule=damper.exit_rule,
        tolerances=TOLERANCES if tolerances is None else tolerances,
        displacement_limit=displacement_limit,
        share=share,
        absorber=absorber,
        effort=Effort() if effort is None else effort,
    )
    return answer(task, evaluate_gap, "Evaluation of an impact damper", folder, progress)


def answer(task, decide, title, folder, progress) -> xr.Dataset:
    """Return one dataset: the decision, computed by `decide`, and all results that follow it."""
    step = Steps(folder, progress, task.describe()).step
    decision = step("decision", decide, task)
    parts, status = [decision], []
    for name, compute in ADDITIONS.items():
        try:
            parts.append(step(name, compute, task, decision))
            status.append(flag("addition_status", "computed"))
        except NUMERICAL as error:
            decision.attrs[f"failed_{name}"] = f"{type(error).__name__}: {error}"
            status.append(flag("addition_status", "failed"))
    parts.append(labelled({"addition_status": status}, addition=list(ADDITIONS)))
    data = xr.merge(parts, compat="override", join="outer", combine_attrs="override")
    damper = describe_si(task.machine, task.damper(1e-3 * float(decision["design_gap"])))
    used = task.describe()
    if "gap" in task.tolerances:
        used["tolerances"]["gap"] = float(task.deviations(float(decision["design_gap"]))[0])
    failed = {key: value for key, value in decision.attrs.items() if key.startswith("failed_")}
    data.attrs = failed | {
        "Conventions": "CF-1.11",
        "title": title,
        "source": SOURCE,
        "machine": json.dumps(damper, sort_keys=True),
        "parameters": json.dumps(used, sort_keys=True),
    }
    return data


class Steps:
    """Runs the steps of a design. If a folder is given, each step saves its dataset there.

    A later run reads this dataset if `inputs` (the task) and the library's code are unchanged.
    """

    def __init__(self, folder, progress, inputs):
        self.folder, self.progress = None if folder is None else Path(folder), progress
        self.made = json.dumps(inputs | {"sources": _sources()}, sort_keys=True)

    def step(self, name, compute, *given):
        """Return `compute(*given)`, or the dataset that an earlier run saved as `name`."""
        title = name.capitalize() if self.progress else None
        if self.folder is None:
            return compute(*given, progress=title)
        path = self.folder / f"{name}.nc"
        try:
            kept = load(path)
            if kept.attrs.get("made") == self.made:
                return kept
        except (FileNotFoundError, BrokenFileError):
            pass  # the dataset is computed below
        self.folder.mkdir(parents=True, exist_ok=True)
        found = compute(*given, progress=title)
        save(found.assign_attrs(made=self.made, source="impact-damper"), path)
        return load(path)


def _sources():
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
