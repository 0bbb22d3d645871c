"""Test cases, called scenes, of the stage `accuracy`: motions on which methods are compared.

A stage is a step of the workflow. A motion that is not chaotic has a reference: the state at its
end, its contacts and its amplitude, computed with 80-bit numbers and taken as exact.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass and W T
the phase of the forcing.
"""

from typing import NamedTuple

import numpy as np

from chatterjee1995.methods.methods import ERRORS, STATISTICS
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator, pick
from impact_damper.motions.strobe_map import strobe_time


class ComparisonScene(NamedTuple):
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
        Forcing cycles of a run.
    motion : str
        "steady" for a periodic motion of one forcing cycle, which some models compute without a
        run; "transient"; or "chaotic".
    accuracy : dict
        Accuracy that a user wants. The entry "quantity" is a name in `methods.ERRORS`, or in
        `methods.STATISTICS` for a chaotic motion. The entry "within" is the largest error that the
        user accepts.
    tolerance : float or None
        Tolerance of the integrator with which other stages run such motions; None if no other stage
        runs them.
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
        """Packed parameters, shape (packed.COUNT,)."""
        return pack(self.oscillator, self.damper, self.frequency)


def check_accuracy(motion, accuracy):
    """Raise ValueError if `accuracy["quantity"]` is not defined for this kind of motion."""
    allowed = STATISTICS if motion == "chaotic" else ERRORS
    if accuracy["quantity"] not in allowed:
        raise ValueError(
            f"accuracy: quantity = {accuracy['quantity']!r}: must be one of {', '.join(allowed)} "
            f"for a {motion} motion"
        )


class Reference(NamedTuple):
    """Values of a run that are taken as exact. The names are those of attributes of `runs.Run`."""

    state: np.ndarray
    contact_times: np.ndarray
    displacement: float


def reference_of(scene, stored):
    """Return the reference of a scene from its entry in `workflow/resources/references.json`.

    Raises
    ------
    ValueError
        If the entry belongs to another scene.
    """
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
    times = np.array([contact[1] for contact in stored["contacts"]])
    return Reference(np.array(stored["state"]), times, stored["amplitude"])
