"""The page of a design in HTML, with figures and with a conclusion in sentences."""

import base64
import io
import json
import re
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from impact_damper.data.datasets import decode, load, named, parameters_of
from impact_damper.data.design_variables import KEEPS, WORTH
from impact_damper.data.sweeps import runs_of_true
from impact_damper.data.whole_files import BrokenFileError, check_writable, whole
from impact_damper.model.machine import GRAVITY
from impact_damper.model.text import number, percent, with_unit
from impact_damper.plot import style
from impact_damper.plot.machine_figures import ENDLESS, FIGURES

DPI = 220
# A page of this package is recognised by this text, the beginning of a line of HTML.
GENERATOR = '<meta name="generator" content="impact-damper'


def conclusion(data) -> list[str]:
    """Return the conclusion of a design or an evaluation in paragraphs."""
    return _conclusion(numbers_of(data))


def check_folder(folder, machine, force) -> None:
    """Raise OSError if files cannot be written into a folder.

    Without `force`, also raise OSError if the folder has a page of another program, or data of
    another machine.
    """
    check_writable(folder / "index.html")
    if force:
        return
    page = folder / "index.html"
    if page.exists() and GENERATOR not in page.read_text(errors="replace")[:1000]:
        raise FileExistsError(
            f"{page} is no page of impact-damper: choose another --output, or replace it by --force"
        )
    for path in (folder / f"{name}.nc" for name in ("design", "evaluation", "migration")):
        try:
            held = parameters_of(load(path)).get("machine")
        except (FileNotFoundError, BrokenFileError):
            continue
        if held != machine:
            raise FileExistsError(
                f"{path} is of another machine: choose another --output, or replace it by --force"
            )


def write_page(name, data, folder, file=None, date="", figures=FIGURES) -> None:
    """Write `index.html`, the page of the machine `name`, into a folder.

    `file` is the name of the data file, by default `name`.nc, and `date` the day it was written.
    `figures` maps the name of a figure to a function of `data` that returns the figure or None.
    """
    drawn, pictures = {each: draw(data) for each, draw in figures.items()}, {}
    for each, figure in drawn.items():
        if figure is not None:
            with style.context(), io.BytesIO() as png:
                figure.savefig(png, format="png", dpi=DPI, metadata={"Software": None})
                pictures[each] = png.getvalue()
    with whole(Path(folder) / "index.html") as part:
        part.write_bytes(page_of(name, data, pictures, file, date).encode())


def page_of(name, data, pictures, file=None, date="") -> str:
    """Return the page in HTML (see `write_page`). `pictures` maps names of figures to PNG data."""
    numbers = numbers_of(data)
    numbers |= {
        "title": f"Impact damper for the machine {name.replace('_', ' ')}",
        "conclusion": _conclusion(numbers),
        "file": file or f"{name}.nc",
        "input": data.attrs.get("input_file", f"the entry {name} of the configuration"),
        "version": version("impact-damper"),
        "date": date,
        "generator": Markup(GENERATOR),
        "pictures": {each: base64.b64encode(png).decode() for each, png in pictures.items()},
        "sources": [],
    }
    return _environment(True).get_template("design.jinja").render(numbers).lstrip()


def _conclusion(numbers):
    text = _environment(False).get_template("conclusion.jinja").render(numbers)
    parts = [_one_line(part) for part in re.split(r"\n\s*\n", text) if part.strip()]
    return [re.sub(r" ([,.:;])", r"\1", part) for part in parts]


def _environment(escaping):
    environment = Environment(
        loader=PackageLoader("impact_damper.plot.pages"),
        autoescape=escaping,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"number": number, "percent": percent, "size": size}
    environment.filters["one_line"] = _one_line
    environment.tests["finite"] = lambda value: np.isfinite(value) and value < ENDLESS
    return environment


def _one_line(text):
    joined = " ".join(str(text).split())
    return Markup(joined) if isinstance(text, Markup) else joined


# Decay time: time in which an unforced vibration falls to this fraction of the first displacement.
DECAY = 0.1
# Words on the page for optional results (ADDITIONS), and for values with a tolerance (QUANTITIES).
ADDITIONS = {
    "response": "motions and forces at the gap",
    "orbits": "the quiet orbit over the gap",
    "forces": "other excitations",
    "masses": "other loose masses",
    "transients": "sweeps and decay",
    "shocks": "impulses on the machine",
    "competitors": "the tuned absorber over the frequency",
}
QUANTITIES = {
    "gap": "gap",
    "restitution": "restitution",
    "contact_stiffness": "stiffness of the walls",
    "gravity": "gravity along the gap",
    "friction": "friction of the loose mass",
    "stiffness": "stiffness of the spring",
    "damping": "damping",
    "force": "excitation",
}
# With fewer than HARDLY impacts in a cycle the loose mass is only ballast.
HARDLY = 0.2
# GIVEN has a row for each property of a machine: key, description, unit on the page, SI value of
# this unit, and key of the property in `tolerances`, or None. COSTS has a row for each variable of
# a design: name, description, unit on the page, and factor that converts the variable to this unit.
TABLES = {
    "GIVEN": (
        ("mass", "mass without the loose mass", "kg", 1, None),
        ("linear_stiffness", "stiffness of the spring", "N/m", 1, "stiffness"),
        ("cubic_stiffness", "cubic stiffness of the spring", "N/m³", 1, "stiffness"),
        ("damping_ratio", "damping ratio", "%", 0.01, "damping"),
        ("damping", "coefficient of the dashpot", "N s/m", 1, "damping"),
        ("force", "amplitude of the force", "N", 1, "force"),
        ("unbalance", "unbalance", "kg mm", 1e-3, "force"),
        ("base_displacement", "amplitude of the moving base", "mm", 1e-3, "force"),
        ("base_acceleration", "amplitude of the base's acceleration", "m/s²", 1, "force"),
    ),
    "COSTS": (
        ("contact_force_by_frequency", "largest force in a contact", "N", 1),
        ("penetration_by_frequency", "largest penetration of a wall", "mm", 1),
        ("impact_speed_by_frequency", "largest relative speed of an impact", "m/s", 1),
        ("impact_rate_by_frequency", "impacts", "per second", 1),
        ("impact_power_by_frequency", "mean power lost in impacts, which becomes heat", "W", 1),
        ("pressure_by_frequency", "largest pressure after Hertz", "MPa", 1e-6),
        (
            "acceleration_by_frequency",
            "largest acceleration of the machine, with impacts",
            "m/s²",
            1,
        ),
        ("absolute_displacement_by_frequency", "largest absolute displacement", "mm", 1),
    ),
}


def size(value, unit="mm", digits=3) -> str:
    """Return a value with its unit, or "escapes" if it is infinite, or "not known" if it is NaN."""
    if np.isnan(value):
        return "not known"
    escapes = np.isinf(value) or (unit == "mm" and value >= ENDLESS)
    return "escapes" if escapes else with_unit(float(value), unit, digits)


def numbers_of(data) -> dict:
    """Return the numbers and texts for the page of a design, by their names in the templates."""
    asked = parameters_of(data)  # arguments of the design
    gap, tolerances = float(data["design_gap"]), asked["tolerances"]
    tolerance = tolerances.get("gap", 0.0)
    ends = gap * (1 - tolerance), gap * (1 + tolerance)
    nominal = data["promise_displacement"].values[0]
    scalars = {name: float(each) for name, each in data.items() if each.ndim == 0}
    found = TABLES | {
        "asked": asked,
        "made": json.loads(data.attrs["machine"]),
        "has": lambda name: name in data,
        "of": scalars,
        "flags": lambda name: named(data, name),
        "own": scalars.get("own_absorber_displacement", np.nan),
        "gap": gap,
        "given": asked["gap"] is not None,
        "tolerance": tolerance,
        "ends": ends,
        "tolerances": [
            f"{QUANTITIES[key]} {percent(value)}" for key, value in tolerances.items() if value
        ],
        "nominal": float(np.nanmax(nominal)),
        "sets": len(data["promise_factor"]),
        "worst_values": _worst_values(data),
        "untouched": _peak(data, "untouched_displacement").size,
        "based": any(map(asked["machine"].get, ("base_displacement", "base_acceleration"))),
        "hits": _hits(data),
        "ballast": _hits(data) < HARDLY,
        "linear": not asked["machine"].get("cubic_stiffness"),
        "condition": _condition(data),
        "lost": list(zip(data["lost_gap"].values, data["lost_displacement"].values, strict=True)),
        "ranges": list(
            zip(data["range_gap"].values, data["range_displacement"].values, strict=True)
        ),
        "inclination": np.degrees(np.arcsin(np.clip(asked["gravity"] / GRAVITY, -1, 1))),
        "worse": _worse(data, nominal),
        "other": _other_mass(data, asked),
        "failed": [
            ADDITIONS.get(str(name), str(name))
            for name, status in zip(
                data["addition"].values, decode(data["addition_status"]).values, strict=True
            )
            if status == "failed"
        ],
        "unsettled": float(np.nanmax(data["unsettled_share"])),
        "late": float(np.fmax.reduce(data["settling_late"].values)),
        "peak": lambda name: _peak(data, name),
        "absorber": {
            key: float(data[f"absorber_{key}"].sel(competitor="tuned", detuning=0.0))
            for key in ("stiffness", "damping")
            if f"absorber_{key}" in data
        },
        "masses": _masses(data, asked),
        "shock": _shocks(data),
    }
    return found | _transients(data, asked)


def _hits(data) -> float:
    if "impact_rate_by_frequency" not in data:
        return np.nan
    return float((data["impact_rate_by_frequency"] / data["frequency"]).max())


def _peak(data, name) -> SimpleNamespace:
    if name not in data or np.isnan(data[name]).all():
        return SimpleNamespace(size=np.nan, frequency=np.nan)
    k = int(np.nanargmax(data[name].values))
    return SimpleNamespace(size=float(data[name][k]), frequency=float(data["frequency"][k]))


def _worst_values(data):
    factors = data["promise_factor"].values[int(data["promised_set"])]
    return [
        f"{QUANTITIES[str(name)]} {'+' if factor > 1 else '-'}{percent(abs(factor - 1))}"
        for name, factor in zip(data["varied"].values, factors, strict=True)
        if factor != 1
    ]


def _shocks(data):
    if "shock_return" not in data:
        return None
    impulses, cycles = np.abs(data["shock_impulse"].values), data["shock_return"].values
    critical = float(data["critical_shock"])
    shares = zip(data["return_limit"].values, data["returned_share"].values, strict=True)
    return SimpleNamespace(
        critical=critical,
        most=float(impulses.max()),
        longest=cycles[impulses < critical].max(initial=0.0),
        shares=list(shares),
    )


def _condition(data):
    """Return the smallest change of gap or excitation that breaks the promise, or None."""
    gap, promised = float(data["design_gap"]), float(data["promised_displacement"])
    found = []
    lost = (
        data["lost_gap"].values,
        data["lost_displacement"].values,
        decode(data["lost_kind"]).values,
    )
    for side, end, moved, kind in zip(("above", "below"), *lost, strict=True):
        if kind != "none":
            facts = {"side": side, "end": end, "size": moved, "margin": abs(end / gap - 1)}
            found.append(SimpleNamespace(kind=kind, **facts))
    if "force_map_displacement" in data:
        shares = data["force_share"].values
        sizes = data["force_map_displacement"].max("operating_frequency").values
        # Above the given excitation, the displacement allowed is proportional to the excitation.
        kept = sizes <= KEEPS * promised * np.maximum(shares, 1)
        for step in (1, -1):
            k = int(np.argmin(np.abs(shares - 1)))
            while 0 <= k + step < len(shares) and kept[k + step]:
                k += step
            if 0 <= k + step < len(shares):
                facts = {"beyond": shares[k + step], "size": sizes[k + step]}
                margin = abs(shares[k + step] - 1)
                found.append(SimpleNamespace(kind="force", margin=margin, **facts))
    return min(found, key=lambda each: each.margin, default=None)


def _worse(data, nominal):
    if float(data["worst_ratio"]) <= 1:
        return None
    known = ~np.isnan(nominal)
    names = ("promise_frequency", "promise_bare_displacement")
    frequency, bare = (data[name].values[known] for name in names)
    ratio = nominal[known] / bare
    k = int(np.argmax(ratio))
    spans = [
        size(frequency[first], "Hz", 4)
        if after - first == 1
        else f"{number(frequency[first], 4)} to {size(frequency[after - 1], 'Hz', 4)}"
        for first, after in runs_of_true(ratio > 1)
    ]
    return SimpleNamespace(spans=spans, size=nominal[known][k], bare=bare[k], at=frequency[k])


def _other_mass(data, asked):
    missed = named(data, "limit_status") == "missed"
    fails = missed or named(data, "decision") == "do_not_build"
    if "other_mass" not in data or not fails:
        return None
    most = (1 - WORTH) * float(data["largest_bare_displacement"])
    good = data["other_displacement"] <= (float(data["displacement_limit"]) if missed else most)
    good &= ~np.isclose(data["other_mass"], asked["mass"])
    if not good.any():
        return None
    k = int(np.argmax(good.values))
    names = ("mass", "gap", "displacement")
    return SimpleNamespace(**{name: float(data[f"other_{name}"][k]) for name in names})


def _masses(data, asked):
    if "other_mass" not in data:
        return []
    names = ("other_mass", "other_gap", "other_displacement", "other_force")
    rows = []
    for mass, gap, moved, force in zip(*(data[name].values for name in names), strict=True):
        note = " (this one)" * bool(np.isclose(mass, asked["mass"]))
        rows.append([size(mass, "kg") + note, size(gap), size(moved), size(force, "N")])
    return rows


def _transients(data, asked):
    if "sweep_envelope" not in data:
        return {"swept": [], "rung": None}
    low, high = asked["band"]
    swept = []
    for direction in data["direction"].values:
        each = data.sel(direction=direction)
        inside = (each["sweep_frequency"] >= low) & (each["sweep_frequency"] <= high)
        sizes = each["sweep_envelope"].where(inside).max("sweep_window")
        bare, damped = (float(sizes.sel(equipment=name)) for name in ("bare", "damped"))
        swept.append({"direction": direction, "bare": bare, "damped": damped})
    rung = {"first": float(data["ring_envelope"].sel(equipment="bare")[0])}
    for equipment in ("bare", "damped"):
        each = data.sel(equipment=equipment)
        sizes, times = each["ring_envelope"].values, each["ring_time"].values
        below = sizes < DECAY * sizes[0]
        rung[equipment] = float(times[np.argmax(below)]) if below.any() else np.nan
    return {"swept": swept, "rung": rung}
