"""Find the machine that fits a measured curve. NumPy and SciPy are imported only when needed."""

import csv
import re
from pathlib import Path
from typing import NamedTuple

from impact_damper.model.bounds import names_arguments, shown
from impact_damper.model.units import QUANTITIES, check_si

# Title of a column in a CSV file: name and unit, such as "time_s" or "displacement [mm]".
COLUMN = re.compile(r"\s*([a-z]+)[\s_\[(]+([^\s\])]+)[\])]?\s*")
FEWEST = 20
SPRING = ("linear_stiffness", "damping", "cubic_stiffness")
# `from_response` divides the error R of the balance by s = dR/d ln a, where a is the amplitude.
# Near a jump of the response s is almost 0, so the divisor is (s^2 + FOLD^2)^(1/2). s depends on
# the fitted values. So PASSES fits are made in turn, each with s from the values found before.
FOLD, PASSES = 0.1, 6


class Identified(NamedTuple):
    """A machine found by a fit, and the uncertainties of its values.

    `uncertainties` has the standard uncertainty, in SI units, of each fitted field of `machine`. It
    is assumed that the errors of the samples are independent and equally large. `noise` is the
    standard deviation of the residuals. After `from_ring_down` it is in m. After `from_response`
    it is a fraction of the amplitude of each sample.
    """

    machine: object
    uncertainties: dict[str, float]
    noise: float
    ended: str


@names_arguments
def from_ring_down(cls, data, *, mass, **excitation) -> Identified:
    """Find the machine whose decay m x'' + c x' + k x + k3 x^3 = 0 fits a measured decay best.

    Parameters
    ----------
    data : str, pathlib.Path, or sequence of 2 arrays
        CSV file whose first line names columns and units, such as "time_s, displacement_mm"; or
        two arrays of shape (n,), n >= 20: time (s) and displacement (m). A constant offset of the
        displacement is fitted too.
    mass : float, str or pint.Quantity
        Exact mass, kg. The stiffnesses and the damping found are proportional to this mass.
    excitation
        Excitation of the machine that is returned, such as force="40 N"; by default force=0.

    Raises
    ------
    TypeError, ValueError
        If `data` are not as described. The message names a wrong cell of a file.

    Examples
    --------
    >>> time = np.linspace(0, 2, 801)
    >>> record = time, 1e-3 * np.exp(-2 * time) * np.cos(100 * time)
    >>> found = Machine.from_ring_down(record, mass="3 kg")
    >>> round(found.machine.linear_stiffness), round(found.machine.damping, 3)
    (30012, 12.0)
    """
    mass = check_si("mass", mass, "mass", above=0)
    time, measured = _read(data, ("time", "displacement"))
    if min(time[1:] - time[:-1]) <= 0:
        raise ValueError("time: must increase from sample to sample")

    def residuals(p):
        return _free(time, p[:5]) + p[5] - measured[:, None]

    values, errors, noise, ended = _fit(residuals, *_decay(time, measured))
    found = {name: mass * value for name, value in zip(SPRING, values, strict=False)}
    errors = {name: mass * error for name, error in zip(SPRING, errors, strict=False)}
    machine = cls(mass=mass, **found, **(excitation or {"force": 0.0}))
    return Identified(machine, errors, noise, ended)


@names_arguments
def from_response(cls, data, *, force) -> Identified:
    """Find the machine whose response to a known force fits a measured response best.

    The response obeys the balance of the first harmonic, (k - m w^2 + 3/4 k3 a^2)^2 a^2 + (c w a)^2
    = F^2 (Nayfeh and Mook, Nonlinear Oscillations, section 4.1, 1979). In balance R = ln(left
    side/right side)/2 is 0. The residual R/(dR/d ln a) is nearly the relative error of a. Higher
    harmonics are neglected. Where 3/4 k3 a^2 exceeds k/10, they change the fitted stiffness by
    about 1 %, and near a jump the fitted damping by 10 %.

    Parameters
    ----------
    data : str, pathlib.Path, or sequence of 2 arrays
        CSV file whose first line names columns and units, such as "frequency_Hz, displacement_mm";
        or two arrays of shape (n,), n >= 20: frequency (Hz) and amplitude a of the first harmonic
        (m). Samples may have any order, and must lie on both sides of the resonance.
    force : float, str or pint.Quantity
        Amplitude F of the force (N), equal for all samples.

    Raises
    ------
    TypeError, ValueError
        If `data` are not as described. The message names a wrong cell of a file.

    Examples
    --------
    >>> f = np.linspace(10, 25, 61)
    >>> curve = f, 5 / abs(3e4 - 3 * (2 * np.pi * f) ** 2 + 12j * 2 * np.pi * f)
    >>> found = Machine.from_response(curve, force="5 N")
    >>> round(found.machine.mass, 6), round(found.machine.damping, 6)
    (3.0, 12.0)
    """
    import numpy as np

    force = check_si("force", force, "force", above=0)
    frequency, a = _read(data, ("frequency", "displacement"))
    if min(*frequency, *a) <= 0:
        raise ValueError("frequency, displacement: must be greater than 0")
    w, square = 2 * np.pi * frequency[:, None], a[:, None] ** 2

    def balance(p):
        return p[0] + 0.75 * p[2] * square - p[3] * w**2 + 1j * p[1] * w

    def residuals(p):
        return np.log(np.abs(balance(p)) * np.sqrt(square) / force) / slope

    values, scale = _resonance(w[:, 0], a, force)
    for _ in range(PASSES):
        z = balance(values)
        slope = np.hypot(1 + 1.5 * values[2] * square * z.real / np.abs(z) ** 2, FOLD)
        values, errors, noise, ended = _fit(residuals, values, scale)
    names = (*SPRING, "mass")
    machine = cls(force=force, **dict(zip(names, values, strict=True)))
    return Identified(machine, dict(zip(names, errors, strict=True)), noise, ended)


def _fit(residuals, guess, scale):
    import numpy as np
    from scipy.optimize import least_squares

    steps = np.column_stack([np.zeros(len(scale)), np.diag(1e-5 * scale)])

    def slopes(p):
        found = residuals((p * scale)[:, None] + steps)
        return (found[:, 1:] - found[:, :1]) / 1e-5

    def single(p):
        return residuals((p * scale)[:, None])[:, 0]

    found = least_squares(single, guess / scale, slopes, method="lm", max_nfev=50)
    noise = float(np.sqrt(2 * found.cost / (len(found.fun) - len(guess))))
    _, singular, rows = np.linalg.svd(found.jac, full_matrices=False)
    errors = noise * scale * np.linalg.norm(rows / singular[:, None], axis=0)
    return (found.x * scale).tolist(), errors.tolist(), noise, found.message


def _free(time, parameters):
    # The result has x(t) of unforced motions x'' + c x' + k x + k3 x^3 = 0, one in each column.
    # `parameters` has a column for each motion: k, c, k3, and x and x' at the first time.
    import numpy as np
    from scipy.integrate import solve_ivp

    stiffness, damping, cubic = parameters[:3]

    def slope(_, y):
        x, v = y.reshape(2, -1)
        return np.concatenate([v, -damping * v - (stiffness + cubic * x**2) * x])

    start, ends = parameters[3:].ravel(), time[[0, -1]]
    least = 1e-8 * np.max(np.abs(start))
    found = solve_ivp(slope, ends, start, "DOP853", time, rtol=1e-8, atol=least)
    count = parameters.shape[1]
    if not found.success:  # the motion escapes: return values far from any measurement
        return np.full((len(time), count), 1e3 * np.max(np.abs(parameters[3])))
    return found.y[:count].T


def _decay(time, measured):
    # The first result has guesses for k/m, c/m, k3/m, x(0), x'(0) and the offset. The second has
    # the positive scales by which the fit divides these values.
    import numpy as np
    from scipy.signal import hilbert

    t = np.linspace(0, time[-1] - time[0], len(time))
    offset = np.mean(measured)
    signal = hilbert(np.interp(time[0] + t, time, measured) - offset)
    begin = 1 + len(t) // 30  # an analytic signal is wrong near its ends
    sizes = np.abs(signal[begin:-begin])
    top = np.argmax(sizes)
    end = begin + top + np.argmax(np.append(sizes[top:] < 0.1 * sizes[top], True))
    t, signal, step = t[begin:end], signal[begin:end], t[1]
    rate, size = np.polyfit(t, np.log(np.abs(signal)), 1)
    if rate >= 0:
        raise ValueError("displacement: must decay, and does not")
    squares = step * np.cumsum(np.exp(2 * (rate * t + size)))
    columns = np.column_stack([np.ones(len(t)), t, squares])
    phase, w, slope = np.linalg.lstsq(columns, np.unwrap(np.angle(signal)), rcond=None)[0]
    a, start = np.exp(size), np.exp(size + 1j * phase)
    spring = w**2 + rate**2, -2 * rate, 8 * w * slope / 3
    scale = w**2, w, w**2 / a**2, a, a * w, a
    return np.array([*spring, start.real, -w * start.imag, offset]), np.array(scale)


def _resonance(w, amplitude, force):
    # The first result has guesses for k, c, k3 and m. The second has the positive scales by which
    # the fit divides these values.
    import numpy as np

    top = np.argmax(amplitude)
    damping = force / (w[top] * amplitude[top])
    size = np.sqrt(np.maximum((force / amplitude) ** 2 - (damping * w) ** 2, 0))
    columns = np.column_stack([np.ones(len(w)), 0.75 * amplitude**2, -(w**2)])
    side = np.where(w < w[top], 1, -1)
    for _ in range(5):
        weighted = columns * amplitude[:, None], side * size * amplitude
        stiffness, cubic, mass = np.linalg.lstsq(*weighted, rcond=None)[0]
        side = np.sign(columns @ [stiffness, cubic, mass])
    scale = (stiffness, damping, stiffness / amplitude[top] ** 2, mass)
    return np.array([stiffness, damping, cubic, mass]), np.abs(scale)


def _read(data, kinds):
    import numpy as np

    is_file = isinstance(data, (str, Path))
    columns = [np.array(each, float) for each in (_columns(Path(data), kinds) if is_file else data)]
    shapes = {each.shape for each in columns}
    alike = len(columns) == 2 and len(shapes) == 1 and columns[0].ndim == 1
    if not alike or len(columns[0]) < FEWEST or not np.all(np.isfinite(columns)):
        raise ValueError(
            f"data = {data if is_file else shown(data)}: must be {' and '.join(kinds)}, finite, of "
            f"the same length, at least {FEWEST}"
        )
    return columns


def _columns(path, kinds):
    with path.open(encoding="utf-8-sig", newline="") as file:
        reader = csv.DictReader(file)
        matches = filter(None, map(COLUMN.fullmatch, reader.fieldnames or ()))
        titles = {match[1]: match for match in matches}
        factors = {}
        for kind in kinds:
            wanted, found = f"{kind}_{QUANTITIES[kind].label}", shown(reader.fieldnames)
            if kind not in titles:
                words = f"must name a column such as {wanted}; has {found}"
                raise ValueError(f"{path}, line 1: {words}")
            where = f"{path}, line 1, unit of {kind}"
            factors[kind] = check_si(where, f"1 {titles[kind][2]}", kind)
        rows = [
            [f * _cell(path, reader.line_num, k, row[titles[k][0]]) for k, f in factors.items()]
            for row in reader
        ]
    return list(zip(*rows, strict=True))


def _cell(path, line, kind, text):
    try:
        return float(text)
    except (TypeError, ValueError):
        where = f"{path}, line {line}, column {kind}"
        raise ValueError(f"{where} = {shown(text)}: must be a number") from None
