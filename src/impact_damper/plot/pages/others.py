"""Section of a page: comparison with tuned absorbers and with other loose masses."""

import itertools

import numpy as np

from impact_damper.data.datasets import flag, parameters_of
from impact_damper.plot.machine_figures import competitors, masses
from impact_damper.plot.pages.blocks import Numbers, Picture, Points, Section, Table, Words, shown

NAMES = {
    "bare": "no damper",
    "this": "this impact damper",
    "tuned": "the tuned absorber",
}
HEAD = (
    "The absorber has the same mass as the damper, and the stiffness and damping that minimise the "
    "largest displacement of a linear machine. With the damper displacements are the largest of "
    "all motions from random starts and from slow changes of the frequency."
)
BALANCE = (
    "This machine has a cubic spring. Its displacements alone and with the absorber are the "
    "balance of one harmonic, and the absorber is tuned to the linear part of the spring: other "
    "motions can be larger, and another absorber can be better."
)
MASSES = (
    "Impact dampers of other masses, each with its own gap, chosen by a shortened design. A star "
    "marks a damper on the Pareto front: no other of these dampers is better in displacement, "
    "force and mass at once."
)
SOURCES = (
    "competitor_displacement, reached_displacement (this damper, nominal excitation), "
    "force_map_displacement (this damper, other excitations)"
)
COLUMNS = ["", "as designed", "springs 10 % off", "excitation / 4", "excitation x 4", "smallest at"]


def section(data) -> Section:
    """Return the section for the dataset of `stages.machines.design_damper`."""
    over_frequency, over_force = _sizes(data)
    blocks = [
        Words(HEAD),
        Table(COLUMNS, _rows(data, over_frequency, over_force), SOURCES),
        Points([*_verdict(data, over_frequency), *_ranges(over_force), *_remarks(data)]),
        Numbers(_absorbers(data)),
        Picture("competitors", competitors.CAPTION),
        Words(MASSES),
        Table(*_masses(data)),
        Points([*_lighter(data)]),
        Picture("masses", masses.CAPTION),
    ]
    return Section("Alternatives", blocks)


def _sizes(data):
    """Return two dicts of arrays keyed by competitor: largest displacements in mm.

    The first holds the displacement at each frequency and nominal excitation. The second holds the
    largest displacement over the band at each excitation; its key "share" holds the excitations as
    multiples of the nominal one. The displacement of a motion that escapes is infinite. Competitors
    that cannot be built are left out.
    """
    frequency, force = {}, {}
    for name in NAMES:
        if name == "this":
            frequency[name] = data["reached_displacement"].values
            force[name] = data["force_map_displacement"].values.max(axis=0)
            continue
        sizes = data["competitor_displacement"].sel(competitor=name, detuning=0.0)
        if np.isfinite(sizes.values).any():
            frequency[name] = sizes.sel(force_share=1.0).values
            force[name] = sizes.max("frequency", skipna=False).values
    return frequency, {"share": data["force_share"].values} | force


def _rows(data, over_frequency, over_force):
    """Return the rows of the table of competitors."""
    best = np.array([*over_frequency.values()]).argmin(axis=0)
    rows = []
    for k, (name, sizes) in enumerate(over_frequency.items()):
        detuned = "-"
        if name not in ("bare", "this"):
            off = data["competitor_displacement"].sel(competitor=name, force_share=1.0)
            detuned = shown(off.max(skipna=False), "mm")
        ends = [shown(over_force[name][end], "mm") for end in (0, -1)]
        where = f"{int((best == k).sum())} of {len(best)} frequencies"
        rows.append([NAMES[name], shown(sizes.max(), "mm"), detuned, *ends, where])
    return rows


def _verdict(data, over_frequency):
    """Yield sentences on the best competitor over the band at the nominal excitation."""
    worst = {name: sizes.max() for name, sizes in over_frequency.items()}
    first, second = sorted(worst, key=worst.get)[:2]
    yield (
        f"Over the band, at the nominal excitation, {NAMES[first]} is best: the machine moves at "
        f"most {shown(worst[first], 'mm')}. Next is {NAMES[second]} with "
        f"{shown(worst[second], 'mm')}."
    )
    if first == "this":
        yield "So the impact damper is the right choice here, and it has no spring to adjust."
    elif first == "bare":
        yield "So at this excitation the machine moves least without any damper: build none."
    else:
        off = data["competitor_displacement"].sel(competitor=first, force_share=1.0)
        detuned = float(off.max(skipna=False))
        moves = "escapes" if np.isinf(detuned) else f"moves up to {shown(detuned, 'mm')}"
        what = f"with the springs of {NAMES[first]} 10 % off the machine {moves}"
        if detuned < worst["this"]:
            yield f"So the absorber is better than the impact damper, even if detuned: {what}."
        else:
            yield f"So the absorber is better only as long as it stays tuned: {what}."


def _ranges(over_force):
    """Yield a sentence on the best competitor over the excitation."""
    share = over_force["share"]
    names = [name for name in over_force if name != "share"]
    best = np.array([over_force[name] for name in names]).argmin(axis=0)
    texts = []
    for winner, group in itertools.groupby(range(len(share)), key=lambda k: best[k]):
        places = list(group)
        low, high = share[places[0]], share[places[-1]]
        where = f"at {shown(low, digits=2)}" if low == high else f"from {low:.2g} to {high:.2g}"
        texts.append(f"{NAMES[names[winner]]} {where}")
    yield (
        "Best by the largest displacement over the band, at multiples of the nominal excitation: "
        f"{'; '.join(texts)}."
    )


def _remarks(data):
    """Yield sentences on what the comparison does not show."""
    status = data["competitor_status"]
    if status.sel(competitor="tuned") == flag("competitor_status", "not_possible"):
        yield (
            "A tuned absorber is not possible: the machine has no linear stiffness, so its natural "
            "frequency depends on the amplitude."
        )
    if status.sel(competitor="bare") == flag("competitor_status", "one_harmonic"):
        yield BALANCE


def _absorbers(data):
    """Return the rows of the absorbers' springs and dashpots."""
    rows = []
    for variable, words, unit in (
        ("absorber_stiffness", "stiffness", "N/m"),
        ("absorber_damping", "damping", "N s/m"),
    ):
        value = float(data[variable].sel(competitor="tuned", detuning=0.0))
        if np.isfinite(value):
            rows.append((f"{NAMES['tuned']}: {words}", shown(value, unit), variable))
    for variable, words, unit in (
        ("den_hartog_stiffness", "stiffness", "N/m"),
        ("den_hartog_damping", "damping", "N s/m"),
    ):
        if variable in data:
            what = f"the same by Den Hartog's closed form, for an undamped machine: {words}"
            rows.append((what, shown(data[variable], unit), variable))
    return rows


def _lighter(data):
    """Yield a sentence on the lightest loose mass that is at least as good, if one is lighter."""
    mass, gap, size, share = (
        data[f"other_{name}"].values for name in ("mass", "gap", "displacement", "share")
    )
    here = int(np.argmin(np.abs(mass - parameters_of(data)["mass"])))
    as_quiet = (size <= size[here]) & (share >= share[here])
    k = int(np.argmax(as_quiet))
    if k < here:
        yield (
            f"A lighter loose mass does as well: {shown(mass[k], 'kg')} with a gap of "
            f"{shown(gap[k], 'mm')}. Ask for a design with it before you build."
        )


def _masses(data):
    """Return columns, rows and sources of the table of other masses."""
    here = parameters_of(data)["mass"]
    columns = [
        "loose mass",
        "gap",
        "largest displacement",
        "share of quiet starts",
        "contact force",
    ]
    names = ("mass", "gap", "displacement", "share", "force", "best")
    names = [f"other_{name}" for name in names]
    values = zip(*(data[name].values for name in names), strict=True)
    rows = []
    for mass, gap, size, share, force, best in values:
        note = " (this one)" if np.isclose(mass, here) else ""
        note += " *" if best else ""
        rows.append(
            [
                f"{shown(mass, 'kg')}{note}",
                shown(gap, "mm"),
                shown(size, "mm"),
                shown(share),
                shown(force, "N"),
            ]
        )
    return columns, rows, ", ".join(names)
