"""Folds and symmetry breakings of the oscillator without damper, by the program AUTO-07p.

The equations are in forced_cubic.f90, and AUTO's constants in constants.txt. The command

    python tests/references/auto/folds.py > tests/references/auto/folds.csv

computes the stored numbers again. This module does not import the package under test.
"""

import datetime
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

HERE = Path(__file__).parent
AUTO = Path(os.environ.get("AUTO_DIR", "/usr/lib/auto-07p"))
COMPILER = "gfortran"
DAMPINGS = (0.215, 0.15, 0.107)

# First orbits, found by direct integration: period in forcing cycles; W; damping -> Z1 and Z1' at
# T = 0.
RESPONSE = 1, 4.0, dict.fromkeys(DAMPINGS, (0.0, 0.0))
SUBHARMONIC = 3, 1.8, {0.215: (-0.516, -0.232), 0.15: (0.262, 0.122), 0.107: (-0.745, 0.426)}

# Settings of increasing accuracy: numbers of mesh intervals (NTST) and collocation points (NCOL),
# tolerances (EPSU, EPSS) and longest step (DSMAX). The numbers of the last setting are stored. A
# symmetry breaking is a singular point of the equations, which AUTO reaches only with larger
# tolerances (LOOSE).
SHARP = [
    {"NTST": 100, "NCOL": 4, "EPSU": 1e-11, "EPSS": 1e-9, "DSMAX": 0.02},
    {"NTST": 100, "NCOL": 5, "EPSU": 1e-12, "EPSS": 1e-10, "DSMAX": 0.02},
    {"NTST": 200, "NCOL": 5, "EPSU": 1e-12, "EPSS": 1e-10, "DSMAX": 0.02},
    {"NTST": 200, "NCOL": 7, "EPSU": 1e-12, "EPSS": 1e-10, "DSMAX": 0.015},
]
LOOSE = [
    {"NTST": 100, "NCOL": 4, "EPSU": 1e-7, "EPSS": 1e-6, "DSMAX": 0.03},
    {"NTST": 100, "NCOL": 4, "EPSU": 1e-7, "EPSS": 1e-6, "DSMAX": 0.02},
    {"NTST": 200, "NCOL": 5, "EPSU": 1e-7, "EPSS": 1e-6, "DSMAX": 0.03},
    {"NTST": 200, "NCOL": 5, "EPSU": 1e-7, "EPSS": 1e-6, "DSMAX": 0.02},
]
# Run -> branch, first orbit of the branch, AUTO's stopping condition, kinds of points stored (None
# for all kinds), settings.
RUNS = {
    "response_folds": ("response", RESPONSE, "STOP = ['LP2']", {"fold"}, SHARP),
    "response": ("response", RESPONSE, "UZSTOP = {'W': 0.6}", {"symmetry_breaking"}, LOOSE),
    "subharmonic": ("subharmonic", SUBHARMONIC, "STOP = ['LP3']", None, SHARP),
}
# AUTO's types of points. AUTO calls type 6 a branch point. A branch point of symmetric orbits is a
# loss of symmetry: two orbits that are mirror images of each other branch off.
KINDS = {5: "fold", 6: "symmetry_breaking", 7: "period_doubling", 8: "neimark_sacker"}
# AUTO's type of the last point if the number of steps was too small.
OUT_OF_STEPS = 9
# Relative size of the last digit that AUTO writes.
LAST_DIGIT = 1e-10
# Messages of AUTO after which its results must not be used.
FAILURES = re.compile("NOTE:(?:No convergence|Possible special point|Error)")


def missing():
    """Return the reason why AUTO cannot be run on this computer, or None."""
    if not (AUTO / "lib" / "main.o").exists():
        return f"AUTO-07p is not installed in {AUTO} (Debian: auto-07p; else set AUTO_DIR)"
    if shutil.which(COMPILER) is None:
        return f"AUTO-07p needs a Fortran compiler: {COMPILER} is not installed"
    return None


def versions():
    """Return the versions of AUTO's Debian package and of the compiler."""
    query = ["dpkg-query", "--show", "--showformat", "${Version}", "auto-07p"]
    package, compiler = (
        subprocess.run(command, capture_output=True, text=True, check=True).stdout
        for command in (query, [COMPILER, "--version"])
    )
    return f"auto-07p {package} (Debian), {compiler.splitlines()[0]}"


def build(folder):
    """Compile the equations and link them with AUTO into `folder`/auto."""
    objects = sorted((AUTO / "lib").glob("*.o"))
    command = [COMPILER, "-O2", "-fopenmp", HERE / "forced_cubic.f90", *objects, "-o", "auto"]
    subprocess.run(command, cwd=folder, check=True)


def points(folder, damping, run, setting):
    """Return the special points of one run of AUTO, in order along the branch.

    A RuntimeError says that AUTO lost the branch, ran out of steps, or did not locate a point.
    """
    branch, (periods, frequency, starts), stop, kinds, _ = RUNS[run]
    orbit = first_orbit(damping, frequency, starts[damping], periods)
    np.savetxt(folder / "first_orbit.dat", orbit)
    constants = (HERE / "constants.txt").read_text()
    values = setting | {"frequency": frequency, "damping": damping, "stop": stop}
    (folder / "fort.2").write_text(constants.format(**values))
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    subprocess.run(
        ["./auto"], cwd=folder, env=environment, capture_output=True, check=True, timeout=300
    )
    failures = FAILURES.findall((folder / "fort.9").read_text())
    if failures:
        raise RuntimeError(f"AUTO, {run}, h = {damping}, {setting}: {', '.join(failures)}")
    labelled = list(solutions(folder / "fort.8"))
    if labelled[-1][0] == OUT_OF_STEPS:
        raise RuntimeError(f"AUTO, {run}, h = {damping}, {setting}: not enough steps")
    found = [
        {"damping": damping, "branch": branch, "kind": KINDS[kind]} | measured(solution, periods)
        for kind, solution in labelled
        if kind in KINDS
    ]
    return [point for point in found if kinds is None or point["kind"] in kinds]


def first_orbit(damping, frequency, start, periods):
    """Return rows of T, Z1, Z1', sin W T, cos W T over a period of the orbit of a start."""

    def rate(time, z):
        return z[1], math.cos(frequency * time) - damping * z[1] - z[0] ** 3

    length = periods * 2 * math.pi / frequency
    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-12}
    settled = solve_ivp(rate, (0, 150 * length), start, **options).y[:, -1]
    times = np.linspace(0, length, 200 * periods + 1)
    z = solve_ivp(rate, (0, length), settled, t_eval=times, **options).y
    return np.column_stack([times, *z, np.sin(frequency * times), np.cos(frequency * times)])


def solutions(path):
    """Yield the type and (parameters, profile) of each solution that AUTO stored.

    A header in AUTO's file states the number of values that follow: the profile, with a row for
    each mesh point (time over period, Z1, Z1', sin W T, cos W T), and the parameters.
    """
    lines = path.read_text().splitlines()
    while lines:
        header = [int(word) for word in lines[0].split()]
        kind, rows, columns, length, parameters = (header[k] for k in (2, 6, 7, 8, 11))
        words = np.array(" ".join(lines[1 : length + 1]).split(), float)
        yield abs(kind) % 10, (words[-parameters:], words[: rows * columns].reshape(rows, columns))
        lines = lines[length + 1 :]


def measured(solution, periods):
    """Return frequency and largest |Z1| of a solution, whose period must be `periods` cycles."""
    parameters, profile = solution
    frequency, period = parameters[[0, 10]]
    if not math.isclose(period * frequency, 2 * math.pi * periods, rel_tol=1e-6):
        raise RuntimeError(f"period {period} at W = {frequency}: not {periods} forcing cycles")
    time, displacement, velocity = profile[:, 0] * period, profile[:, 1], profile[:, 2]
    curve = CubicHermiteSpline(time, displacement, velocity)
    turns = curve.derivative().roots(extrapolate=False)
    return {
        "frequency": float(frequency),
        "maximum_displacement": float(f"{np.max(np.abs(curve(turns))):.9g}"),
    }


def found_in(folder, damping, run, settings):
    """Return the points found with the last of several settings, with estimated errors.

    An error is the largest difference between the settings, but at least AUTO's tolerance EPSU and
    the last digit that AUTO writes. Folds met a second time on a closed branch are omitted.
    """
    runs = [points(folder, damping, run, setting) for setting in settings]
    if len({tuple(point["kind"] for point in run) for run in runs}) != 1:
        raise RuntimeError("refinements of AUTO's mesh differ in the points they find")
    least = max(settings[-1]["EPSU"], LAST_DIGIT)
    kept = []
    for same in zip(*runs, strict=True):
        frequencies = [point["frequency"] for point in same]
        spread = max(frequencies) - min(frequencies)
        if not any(abs(point["frequency"] - frequencies[-1]) < 1e-6 for point in kept):
            kept.append(same[-1] | {"frequency_error": max(float(f"{spread:.1e}"), least)})
    return kept


def main():
    with tempfile.TemporaryDirectory() as name:
        build(name)
        found = [
            point
            for damping in DAMPINGS
            for run, (*_, settings) in RUNS.items()
            for point in found_in(Path(name), damping, run, settings)
        ]
    print("# AUTO-07p (E. J. Doedel and others), run by tests/references/auto/folds.py on")
    print("# Z1'' + h Z1' + Z1^3 = cos(W T); maximum_displacement is the largest |Z1|.")
    print(f"# {versions()}, {datetime.date.today().isoformat()}")
    pd.DataFrame(found).to_csv(sys.stdout, index=False)


if __name__ == "__main__":
    main()
