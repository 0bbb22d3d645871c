"""Design of an impact damper for a machine: the gap, its effect, its tests and its costs."""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from impact_damper.data.datasets import SOURCE, load, save
from impact_damper.data.whole_files import BrokenFileError
from impact_damper.design.absorbers import SHARES, absorber_responses
from impact_damper.design.alternatives import best_restitution, other_masses, try_restitutions
from impact_damper.design.chosen_motions import damped_response, reached_motions
from impact_damper.design.cliff import HOLDABLE, LEAD, LONGEST, choose_gap
from impact_damper.design.compare import compare_gaps
from impact_damper.design.deviations import UNSEEN, check_design
from impact_damper.design.operating import operating_maps
from impact_damper.design.quiet_branch import follow_quiet_orbit
from impact_damper.design.screen import screen
from impact_damper.design.task import TOLERANCES, Effort, Task, labelled
from impact_damper.design.transients import transients
from impact_damper.model.bounds import names_arguments, shown
from impact_damper.model.machine import describe_si
from impact_damper.theory.contact_law import contact as contact_law

# The absorber to compare with is tuned over the range from ABSORBED[0] times the lowest frequency
# of band and resonance to ABSORBED[1] times the highest.
ABSORBED = 0.5, 2.0


@names_arguments
def design_damper(
    machine,
    *,
    mass,
    band,
    restitution,
    contact,
    tolerances=None,
    displacement_limit=None,
    share=0.95,
    effort=None,
    folder=None,
    progress=False,
):
    """Design an impact damper for a machine and a band of forcing frequencies.

    Parameters
    ----------
    machine : Machine
    mass : float or str
        Loose mass, kg, at most the mass of the machine. This and all other physical values are
        numbers in the SI unit, texts with units such as "0.6 kg", or quantities of pint.
    band : sequence of 2 floats or str
        Least and greatest forcing frequency, Hz; the resonance of the machine lies between them.
    restitution : float or tuple of 2 floats
        Coefficient of restitution, 0.05 to 1. Two values are the ends of a range from which the
        design chooses the restitution, by a coarse comparison of gaps at each of five values.
    contact : float, str or HertzContact
        Stiffness of the contact, N/m, or the contact of curved bodies. Its stiffness is computed
        for an impact at the speed with which the loose mass crosses the gap of the paper's rule
        (18) in half a forcing cycle, and its pressure for the impacts of the design.
    tolerances : dict, optional
        Largest relative deviations of gap, restitution, contact_stiffness, stiffness, damping and
        force, such as {"gap": "10 %"}; by default 20 % of the gap.
    displacement_limit : float or str, optional
        Quiet limit: a motion in which the machine moves by at most this displacement, m, is quiet.
        By default the design chooses a limit between the smallest motion and the motion without the
        damper.
    share : float
        Least share of the starts that must lead to quiet motions, at 95 % confidence.
    effort : Effort, optional
        How many frequencies, gaps and starts are computed, and with how many threads.
    folder : str or pathlib.Path, optional
        Folder for the results of finished steps, from which an interrupted design continues.
    progress : bool
        Whether progress bars are shown.

    Returns
    -------
    xarray.Dataset
        Each variable has the unit in its attribute `units`, such as mm, Hz or N. `design_gap` is
        the gap to build; `design_choice` and `promise` say how sure it is (see `decode`).
        `plot.conclusion` says the same in sentences, and `plot.design` draws it.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it, in SI units.

    Examples
    --------
    A share of 95 % at 95 % confidence needs 73 starts, all quiet:

    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    >>> damper = {"mass": "1.2 kg", "restitution": 0.6, "contact": 2e7}
    >>> idm.design_damper(
    ...     machine, **damper, band=(20, 21), effort=idm.Effort(starts=20)
    ... )  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ValueError: starts = 20: must be from 73 to ...
    """
    given = {
        "machine": machine,
        "mass": mass,
        "band": band,
        "contact": contact,
        "tolerances": TOLERANCES if tolerances is None else tolerances,
        "displacement_limit": displacement_limit,
        "share": share,
        "effort": Effort() if effort is None else effort,
    }
    steps = Steps(folder, progress)
    tried = None
    if isinstance(restitution, Sequence | np.ndarray) and not isinstance(restitution, str):
        tried = _tried_restitutions(given, restitution, steps)
        restitution = best_restitution(tried)
    task = Task(**given, restitution=restitution)
    step = steps.made_from(task.describe())
    first = step("screening", screen, task)
    compared = step("comparison", compare_gaps, task, first)
    choice = step("cliff", choose_gap, task, compared)
    response = step("response", damped_response, task, choice)
    parts = [
        first,
        compared,
        choice,
        step("orbits", follow_quiet_orbit, task, choice),
        response,
        step("motions", reached_motions, task, choice, response),
        step("tolerances", check_design, task, choice),
        step("maps", operating_maps, task, choice),
        step("masses", other_masses, task, choice),
        step("transients", transients, task, choice),
        step("competitors", competitors, task),
    ]
    if tried is not None:
        parts.insert(0, tried)
    data = xr.merge(parts, compat="override", join="outer", combine_attrs="override")
    damper = describe_si(machine, task.damper(1e-3 * float(choice["design_gap"])))
    used = {"holdable": HOLDABLE, "lead": LEAD, "longest": LONGEST, "unseen": UNSEEN}
    used["pull_free_restitution"] = contact_law(task.restitution, 0.0, "no_tension").departure
    data.attrs = {
        "Conventions": "CF-1.11",
        "title": "Design of an impact damper for a machine",
        "source": SOURCE,
        "machine": json.dumps(damper, sort_keys=True),
        "parameters": json.dumps(task.describe() | used, sort_keys=True),
    }
    return data


def competitors(task, progress=None) -> xr.Dataset:
    """Return the responses of the machine alone and with a tuned absorber of the same mass."""
    low, high = task.resonance
    band = ABSORBED[0] * min(low, task.band[0]), ABSORBED[1] * max(high, task.band[1])
    found = absorber_responses(task.machine, task.mass, task.grid, SHARES, band=band)
    return found.assign_coords(labelled({}, frequency=task.grid).coords)


def _tried_restitutions(given, restitution, steps):
    """Return the dataset of designs with several restitutions between two ends."""
    tasks = [Task(**given, restitution=end) for end in restitution]
    ends = [task.restitution for task in tasks]
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise ValueError(f"restitution = {shown(restitution)}: must be a number or two that ascend")
    step = steps.made_from(tasks[0].describe() | {"restitution": ends})
    return step("restitutions", try_restitutions, tasks[0], ends)


class Steps:
    """Runs steps of a design, and keeps the dataset of each in a file of a folder, if given one."""

    def __init__(self, folder, progress):
        self.folder, self.progress = None if folder is None else Path(folder), progress
        self.made = ""

    def made_from(self, inputs):
        """Return the method `step` for a design from these inputs and these source files."""
        self.made = json.dumps(inputs | {"sources": _sources()}, sort_keys=True)
        return self.step

    def step(self, name, compute, *given):
        """Return the dataset that a function computes, or its file if made from the same inputs."""
        title = name.capitalize() if self.progress else None
        if self.folder is None:
            return compute(*given, progress=title)
        path = self.folder / f"{name}.nc"
        try:
            kept = load(path)
            if kept.attrs.get("made") == self.made:
                return kept
        except (FileNotFoundError, BrokenFileError):
            pass  # computed below
        self.folder.mkdir(parents=True, exist_ok=True)
        found = compute(*given, progress=title)
        save(found.assign_attrs(made=self.made, source="impact-damper"), path)
        return load(path)


def _sources():
    """Return a digest of all source files of the package."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
