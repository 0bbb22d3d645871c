"""Check arguments of public functions, and convert them to dimensionless numbers."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from impact_damper.model.bounds import (
    FARTHEST,
    FASTEST,
    FREQUENCY_RANGE,
    RADIUS_RANGE,
    check_number,
    shown,
    warn,
)
from impact_damper.model.machine import Machine, MachineDamper
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator, describe
from impact_damper.model.units import UNITLESS, Scales

# Physical quantities and SI units of the components Z1, Z1', Z2, Z2' of a state.
STATE = ("displacement", "velocity", "displacement", "velocity")
STATE_UNITS = "m, m/s, m, m/s"
FARTHEST_STATE = dict(zip(STATE, (FARTHEST, FASTEST) * 2, strict=True))
# Dataset coordinates that store the forcing phase W T at which a state is given.
PHASES = ("state_phase", "orbit_phase")


class Model(NamedTuple):
    """An `Oscillator`. It may have a damper and a forcing frequency, and come from a `Machine`."""

    oscillator: Oscillator
    damper: Damper | None
    frequency: float | None = None
    machine: Machine | None = None
    machine_damper: MachineDamper | None = None

    @property
    def scales(self) -> Scales:
        """Scales that convert between the user's units and dimensionless numbers."""
        return self.oscillator.scales

    def pack(self, frequency=None) -> np.ndarray:
        """Return packed parameters at a forcing frequency W, by default the model's frequency."""
        return pack(self.oscillator, self.damper, frequency or self.frequency)

    def describe(self, *others) -> dict:
        """Return a dictionary of the parameters of the model and of the dataclasses `others`."""
        found = describe(self.oscillator, self.damper, *others)
        return found if self.frequency is None else found | {"frequency": self.frequency}


def read_system(system, damper=None, *, needs_damper=False) -> Model:
    """Check arguments and return their `Model`. `damper` may be None unless `needs_damper`."""
    if isinstance(system, Machine):
        if damper is None and not needs_damper:
            return Model(system.oscillator(), None, None, system)
        if not isinstance(damper, MachineDamper):
            raise TypeError(f"damper = {shown(damper)}: must be a MachineDamper, by machine.damper")
        damper.check_for(system)
        return Model(system.oscillator(), damper.scaled(system.scales), None, system, damper)
    if not isinstance(system, Oscillator):
        raise TypeError(f"system = {shown(system)}: must be an Oscillator or a Machine")
    if not isinstance(damper, Damper) and (needs_damper or damper is not None):
        raise TypeError(f"damper = {shown(damper)}: must be a Damper")
    # With an Oscillator all arguments are dimensionless, even if a Machine made the Oscillator.
    return Model(replace(system, scales=UNITLESS), damper)


def read_forced(system, damper, frequency, *, needs_damper=False) -> Model:
    """Return the `Model` with a forcing frequency. For a machine `frequency` is in Hz."""
    model = read_system(system, damper, needs_damper=needs_damper)
    own = model.scales.read("frequency", frequency, "frequency", **FREQUENCY_RANGE)
    return model._replace(frequency=own)


def read_swept_damper(system, damper, frequency) -> Model:
    """Return the model for a sweep of the clearance. The damper's own clearance does not matter.

    If `system` is an `Oscillator`, `damper` may also be a dictionary of mass_ratio and, optionally,
    restitution and contact_stiffness.
    """
    if isinstance(system, Oscillator) and isinstance(damper, dict):
        allowed = {"mass_ratio", "restitution", "contact_stiffness"}
        if not {"mass_ratio"} <= damper.keys() <= allowed:
            raise TypeError(
                f"damper = {shown(damper)}: must have mass_ratio, and may have restitution and "
                "contact_stiffness; the clearance is swept"
            )
        damper = Damper(clearance=1.0, **damper)
    return read_forced(system, damper, frequency, needs_damper=True)


def read_numbers(scales, name, values, kind="number", **bounds) -> np.ndarray:
    """Return a number or a sequence as a dimensionless array. `bounds` are dimensionless too."""
    pairs = _numbered(values)
    return np.array([scales.read(f"{name}[{i}]", value, kind, **bounds) for i, value in pairs])


def _numbered(values):
    if isinstance(values, (list, tuple)) or getattr(values, "ndim", 0) == 1:
        return enumerate(values)
    return enumerate(np.atleast_1d(values) if not hasattr(values, "units") else [values])


def read_increasing(scales, name, values, kind="number", count=1, **bounds) -> np.ndarray:
    """Return a dimensionless array. The numbers must increase. At least `count` are needed."""
    numbers = read_numbers(scales, name, values, kind, **bounds)
    if len(numbers) < count or np.any(np.diff(numbers) <= 0):
        given = shown(list(getattr(values, "values", values)))
        raise ValueError(
            f"{name} = {given}: must be increasing, and at least {count} value{'s' * (count > 1)}"
        )
    return numbers


def read_frequencies(scales, values) -> np.ndarray:
    """Return an increasing array of forcing frequencies W. For a machine `values` are in Hz."""
    return read_increasing(scales, "frequencies", values, "frequency", **FREQUENCY_RANGE)


def read_span(scales, name, span, kind, **bounds) -> tuple[float, float]:
    """Return the two numbers of `span`, the least and the greatest value, dimensionless."""
    ends = read_numbers(scales, name, span, kind, **bounds)
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise ValueError(f"{name} = {shown(span)}: must be two numbers, least and greatest")
    return float(ends[0]), float(ends[1])


def read_radius(scales, radius, whole_gap=False) -> float | None:
    """Return the dimensionless radius of the ball of random starts, or None if `radius` is None.

    If `whole_gap` is true, only Z1 and Z1' of a start lie in the ball, and the loose mass starts
    anywhere in its gap. Then None is an error, and 0 is allowed. Otherwise 0 is an error.
    """
    if radius is None:
        if whole_gap:
            raise ValueError("radius = None: must be given with whole_gap; 0 for a machine at rest")
        return None
    bounds = {"least": 0.0, "most": RADIUS_RANGE["most"]} if whole_gap else RADIUS_RANGE
    return scales.read("radius", radius, "displacement", **bounds)


def read_pair(scales, name, values) -> np.ndarray:
    """Return a displacement and a velocity as two dimensionless numbers."""
    values = getattr(values, "values", values)
    return _components(scales, name, values, STATE[:2], "two numbers, displacement and velocity")


def _components(scales, name, values, kinds, words):
    numbered = list(_numbered(values))
    if len(numbered) != len(kinds):
        raise ValueError(f"{name} = {shown(values)}: must be {words}")
    return np.array(
        [
            scales.read(f"{name}[{i}]", value, kind, least=-most, most=most)
            for (i, value), kind in zip(numbered, kinds, strict=True)
            for most in [FARTHEST_STATE[kind]]
        ]
    )


def read_state(model, state) -> np.ndarray:
    """Return the argument `state` of a public function as Z1, Z1', Z2, Z2', shape (4,).

    Without a damper Z1 and Z1' are enough; then Z2 = Z1 and Z2' = Z1'. Warn if |Z2| > 2 d0.
    """
    scales, damper = model.scales, model.damper
    if hasattr(state, "coords"):
        units, expected = state.attrs.get("units"), STATE_UNITS if scales.si else "1"
        # In a dataset of one motion the state may have extra dimensions of length 1.
        state = np.squeeze(state.values)
        if units not in (None, expected):
            wanted = f"in {STATE_UNITS}, and is" if scales.si else "dimensionless, and is in"
            unit = "dimensionless" if units == "1" else units
            raise ValueError(f"state = {shown(state)}: must be {wanted} {unit}")
    alone = damper is None and len(list(_numbered(state))) == 2
    values = _components(
        scales,
        "state",
        state,
        STATE[:2] if alone else STATE,
        "four numbers, displacement and velocity of the primary mass and of the primary mass "
        "relative to the loose mass, or the first two without a damper (the paper's figure 4 gives "
        "three; a state of this system has four)",
    )
    if alone:
        values = np.concatenate([values, values])
    if damper is not None and abs(values[2]) > 2 * damper.clearance:
        speed = damper.contact_frequency * (abs(values[2]) - damper.clearance)
        warn(
            f"{scales.told('state[2]', values[2], 'displacement')}: the loose mass is beyond its "
            f"wall, which is at {scales.told('clearance', damper.clearance, 'clearance')}; the "
            f"compressed contact throws the mass back with up to "
            f"{scales.told('speed', speed, 'velocity')}",
        )
    return values


def carried_phase(state):
    """Return the phase W T that a dataset stores with a state, or None if no phase is stored."""
    coordinates = getattr(state, "coords", {})
    phases = [coordinates[name].item() for name in PHASES if name in coordinates]
    return check_number("state phase", phases[0]) if phases else None


def read_start(model, state, start) -> float:
    """Return the time T at which a motion begins, from the argument `start`, a time or None.

    If `start` is None, T is the phase stored with the state (`carried_phase`) divided by W, or 0 if
    no phase is stored. A `start` whose phase W T differs from the stored phase is an error.
    """
    phase, frequency = carried_phase(state), model.frequency
    if start is None:
        return 0.0 if phase is None else phase / frequency
    farthest = 1e6 * 2 * np.pi / frequency
    time = model.scales.read("start", start, "time", least=-farthest, most=farthest)
    if phase is not None and abs(math.remainder(frequency * time - phase, 2 * np.pi)) > 1e-6:
        raise ValueError(
            f"{model.scales.told('start', time, 'time')}: must be at the phase W T = {phase:.6g} "
            "that the state carries, or be left out; state.values has no phase"
        )
    return time
