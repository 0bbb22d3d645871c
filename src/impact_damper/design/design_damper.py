"""Design of an impact damper for a machine: the gap, its effect, its tests and its costs.

Cheap steps come first: the screening by exact periodic orbits (`design.screen`), a comparison of
gaps by motions from many initial states (`design.compare`), the choice of the gap (`design.choose`)
and the cliff (`design.cliff`), a gap beyond which fewer initial states lead to small motions. Then
follow motions, deviations, other masses, transients and tuned absorbers.
"""

import json

import xarray as xr

from impact_damper.data.datasets import SOURCE
from impact_damper.design.design_steps import DesignSteps
from impact_damper.design.kept_steps import KeptSteps
from impact_damper.design.restitutions import free_restitution
from impact_damper.design.stiffness import contact_stiffness_of
from impact_damper.design.task import Task
from impact_damper.design.tolerances import TOLERANCES
from impact_damper.design.words import conclusion
from impact_damper.model.machine import describe_si
from impact_damper.model.names import names_arguments


@names_arguments
def design_damper(
    machine,
    *,
    mass,
    band,
    restitution,
    contact_stiffness=None,
    contact=None,
    frequencies=41,
    candidates=12,
    starts=96,
    tolerances=None,
    displacement_limit=None,
    share=0.95,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
    folder=None,
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
    contact_stiffness : float or str, optional
        Stiffness of the contact, N/m.
    contact : HertzContact, optional
        Radius and materials of the contact, for its pressure. If no contact stiffness is given,
        they also determine the stiffness, for an impact at the speed with which the loose mass
        crosses the gap of the paper's rule (18) in half a forcing cycle.
    frequencies : int
        Number of frequencies over the band; the resonances in it are added.
    candidates : int
        Number of gaps that are compared closely.
    starts : int
        Random starts (initial states of machine and loose mass) at each gap and frequency.
    tolerances : dict, optional
        Largest relative deviations of gap, restitution, contact_stiffness, stiffness, damping and
        force, such as {"gap": "10 %"}; by default 20 % of the gap.
    displacement_limit : float or str, optional
        Quiet limit: a motion in which the machine moves by at most this displacement, m, is quiet.
        By default the design chooses a limit between the smallest motion and the motion without the
        damper.
    share : float
        Least share of the starts that must lead to quiet motions, at 95 % confidence.
    seed : int
        Seed of the random starts.
    settling : Settling, optional
        How long motions are run, and how accurately.
    workers : int
        Threads; the result does not depend on it.
    progress : bool, optional
        Whether progress bars are shown.
    folder : str or pathlib.Path, optional
        Folder for the results of finished steps, from which an interrupted design continues.

    Returns
    -------
    xarray.Dataset
        Each variable has the unit in its attribute `units`, such as mm, Hz or N. `design_gap` is
        the gap to build; `design_choice` and `promise` say how sure it is (see `decode`). The
        attribute `conclusion`, a list of sentences as JSON, says the same. `plot.design` draws the
        design.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it, in SI units.

    Examples
    --------
    A share of 95 % at 95 % confidence needs 73 starts, all quiet:

    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    >>> idm.design_damper(
    ...     machine, mass="1.2 kg", band=(20, 21), restitution=0.6, contact_stiffness=2e7, starts=20
    ... )  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ValueError: starts = 20: must be from 73 to ...
    """
    asked = {"machine": machine, "mass": mass, "band": band}
    stiffness = contact_stiffness_of(**asked, stiffness=contact_stiffness, contact=contact)
    given = asked | {
        "contact_stiffness": stiffness,
        "frequencies": frequencies,
        "candidates": candidates,
        "starts": starts,
        "tolerances": TOLERANCES if tolerances is None else tolerances,
        "displacement_limit": displacement_limit,
        "share": share,
        "seed": seed,
        "settling": settling,
    }
    running = {"workers": workers, "progress": "Restitutions" if progress else None}
    restitution, tried = free_restitution(given, restitution, folder, running)
    task = Task(**given, restitution=restitution)
    made = task.describe() | {"machine": describe_si(machine), "contact": repr(contact)}
    design = DesignSteps(task, contact, KeptSteps(folder, made), workers, progress)
    choice, parts = design.run()
    parts = [tried, *parts]
    data = xr.merge(parts, compat="override", join="outer", combine_attrs="override")
    damper = describe_si(machine, task.damper(1e-3 * choice.gap))
    data.attrs = {
        "Conventions": "CF-1.11",
        "title": "Design of an impact damper for a machine",
        "source": SOURCE,
        "machine": json.dumps(damper, sort_keys=True),
        "parameters": json.dumps(made, sort_keys=True),
        "conclusion": json.dumps(conclusion(task, choice.kind, data)),
    }
    return data
