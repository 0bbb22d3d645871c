"""Machines identified from noisy curves that SciPy integrated; wrong files are refused."""

import doctest
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from impact_damper import Machine

PAGE = Path(__file__).parents[3] / "docs/howto/measurement.md"
TRUE = {"mass": 3.0, "linear_stiffness": 3e4, "damping": 24.0}
CUBICS = [0.0, 6e9, -5e9]
FORCE = 5.0


def moved(cubic, force, w, start, times):
    """Return the displacement of the machine at the times, integrated with tight tolerances."""
    mass, stiffness, damping = TRUE.values()

    def slope(t, y):
        rest = force * np.cos(w * t) - damping * y[1] - stiffness * y[0] - cubic * y[0] ** 3
        return y[1], rest / mass

    ends = 0.0, times[-1]
    return solve_ivp(slope, ends, start, "DOP853", times, rtol=1e-9, atol=1e-13).y[0]


def check(found, names, cubic):
    """Errors are below 3 standard uncertainties, uncertainties below 3 % of the largest values."""
    true = TRUE | {"cubic_stiffness": cubic}
    for name in names:
        error = found.uncertainties[name]
        assert abs(getattr(found.machine, name) - true[name]) < 3 * error, name
        assert error < 0.03 * max(abs(true[name]), 6e9 * (name == "cubic_stiffness")), name
    assert "satisfied" in found.ended


@pytest.mark.parametrize("cubic", CUBICS)
def test_ring_down(cubic, tmp_path):
    """The measured decay is in mm and ms, with an offset of the sensor."""
    times, random = np.linspace(0, 1, 1001), np.random.default_rng(5)
    noisy = moved(cubic, 0.0, 0.0, (1e-3, 0.0), times) + 1e-4 + 2e-5 * random.normal(size=1001)
    table = np.column_stack([1e3 * times, 1e3 * noisy])
    path, header = tmp_path / "decay.csv", "time_ms, displacement_mm"
    np.savetxt(path, table, delimiter=",", header=header, comments="")
    found = Machine.from_ring_down(path, mass="3 kg", unbalance=1e-3)
    check(found, ("linear_stiffness", "damping", "cubic_stiffness"), cubic)
    assert found.noise == pytest.approx(2e-5, rel=0.1)
    assert found.machine.unbalance == 1e-3


@pytest.mark.thorough
@pytest.mark.parametrize("cubic", [6e8, -6e8])
def test_response(cubic):
    """A sweep towards the jump: amplitudes, with 1 % errors, after 30 cycles at each frequency."""
    frequencies = np.linspace(10, 22, 49)[:: 1 if cubic > 0 else -1]
    amplitudes, state = [], (0.0, 0.0)
    for w in 2 * np.pi * frequencies:
        times = 2 * np.pi / w * np.arange(30 * 64 + 1) / 64
        x = moved(cubic, FORCE, w, state, times)
        state = x[-1], np.gradient(x, times, edge_order=2)[-1]
        phases = np.exp(-1j * w * times[-64:])
        amplitudes.append(2 * np.abs(np.mean(x[-64:] * phases)))
    noisy = np.array(amplitudes) * (1 + 0.01 * np.random.default_rng(4).normal(size=49))
    found = Machine.from_response((frequencies, noisy), force="5 N")
    check(found, (*TRUE, "cubic_stiffness"), cubic)


HEAD = "time_s, displacement_mm\n"
ROWS = "".join(f"{t}, {np.cos(t) * 1.1**t}\n" for t in range(30))
WRONG = {
    "time_s, force_N\n" + ROWS: "line 1: must name a column such as displacement_mm; has ['time_s'",
    "time_kg, displacement_mm\n" + ROWS: "line 1, unit of time = '1 kg': must be a number in s",
    HEAD + ROWS + "30, much\n": "line 32, column displacement = ' much': must be a number",
    HEAD
    + ROWS
    + "30, nan\n": "must be time and displacement, finite, of the same length, at least",
    HEAD + ROWS + "29, 1\n": "time: must increase",
    HEAD + ROWS: "displacement: must decay, and does not",
}


@pytest.mark.parametrize("text", WRONG)
def test_wrong_file_is_refused_in_words(text, tmp_path):
    path = tmp_path / "wrong.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=re.escape(WRONG[text])):
        Machine.from_ring_down(path, mass=1.0)


def test_examples(tmp_path, monkeypatch):
    """The examples in the docstrings and on the page run."""
    monkeypatch.chdir(tmp_path)
    for method in (Machine.from_ring_down, Machine.from_response):
        names = {"np": np, "Machine": Machine}
        test = doctest.DocTestParser().get_doctest(method.__doc__, names, "example", None, None)
        assert doctest.DocTestRunner().run(test).failed == 0
    exec(re.search(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)[1], {})
