"""The command `impact-damper`: designs, simulations and reports for a machine in a YAML file."""

import json
import sys
import warnings
from datetime import datetime
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import typer

from impact_damper.data.whole_files import check_writable

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False)
MachineFile = Annotated[
    Path, typer.Argument(exists=True, dir_okay=False, help="YAML file of machine, damper and band.")
]
Gap = Annotated[str, typer.Option(help='Full play of the loose mass, such as "3 mm".')]
Kept = Annotated[
    Path, typer.Option(dir_okay=False, callback=check_writable, help="NetCDF file of the result.")
]
Force = Annotated[
    bool, typer.Option("--force", help="Replace the files of another machine, or a foreign page.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Workers = Annotated[int, typer.Option(min=1, help="Threads; the result does not depend on it.")]
INTERRUPTED = 130  # exit code after Ctrl-C


def tell_version(asked: bool):
    """Print the version and exit if the option `--version` is given."""
    if asked:
        print(version("impact-damper"))
        raise typer.Exit


@app.callback()
def main(
    _: Annotated[
        bool,
        typer.Option("--version", callback=tell_version, is_eager=True, help="Print the version."),
    ] = False,
):
    """Impact dampers for machines in SI units.

    For harmonic excitation of one mode; not for self-excited, random or shock excitation.

    A YAML file describes machine, damper and band of frequencies. It must hold at least:

    \b
    machine: {mass: 12 kg, linear_stiffness: 2e5, damping_ratio: 0.5 %, force: 40}
    damper: {mass: 0.6 kg, restitution: 0.7, contact_stiffness: 2e7}
    band: [20 Hz, 21 Hz]

    Plain numbers are in kg, N/m, N, m and Hz.

    The documentation has the pages "Describe a machine in a file" (all keys), "What it is for".
    """


@app.command()
def design(
    machine_file: MachineFile,
    output: Annotated[Path, typer.Option(help="Folder for data, page and kept steps.")] = "design",
    workers: Workers = 2,
    force: Force = False,
    as_json: AsJson = False,
):
    """Find the gap with which the machine moves least, and how sure this answer is.

    A design takes minutes. The same command continues an interrupted design.
    """
    from impact_damper.command.machine_file import design_arguments
    from impact_damper.design.design_damper import design_damper

    given, machine = read(machine_file)
    decide = partial(design_damper, machine, **design_arguments(given, workers))
    answer(decide, machine, machine_file, output / "design.nc", force, as_json)


@app.command()
def evaluate(
    machine_file: MachineFile,
    gap: Gap,
    output: Annotated[Path, typer.Option(help="Folder for data and page.")] = "evaluation",
    workers: Workers = 2,
    force: Force = False,
    as_json: AsJson = False,
):
    """Say how far the machine moves with a given gap, and how sure this answer is.

    The displacement is promised with 95 % confidence, as by `impact-damper design`.
    """
    from impact_damper.command.machine_file import design_arguments
    from impact_damper.design.design_damper import evaluate_damper

    given, machine = read(machine_file)
    names = ("band", "share", "tolerances", "absorber", "displacement_limit", "effort")
    values = design_arguments(given, workers)
    values = {name: values[name] for name in names}
    decide = partial(evaluate_damper, machine, damper(given, machine, gap), **values)
    answer(decide, machine, machine_file, output / "evaluation.nc", force, as_json)


@app.command()
def simulate(
    machine_file: MachineFile,
    frequency: Annotated[str, typer.Option(help='Forcing frequency, such as "24 Hz".')],
    gap: Gap = None,
    state: Annotated[
        str, typer.Option(help="Initial x, x', z, z'; z is relative to the loose mass.")
    ] = "0, 0, 0, 0",
    periods: Annotated[float, typer.Option(help="Length in forcing cycles.")] = 200,
    output: Kept = None,
    as_json: AsJson = False,
):
    """Integrate one motion, without the damper if no gap is given."""
    import numpy as np

    from impact_damper.motions import simulate as motions

    given, machine = read(machine_file)
    system = machine, damper(given, machine, gap), quantity(frequency)
    start = tuple(map(quantity, state.split(",")))
    motion = motions.simulate(*system, start, periods=periods)
    last = motion["displacement"].values[-len(motion["time"]) // 10 :]
    largest = float(np.abs(last).max())
    contacts = motion.sizes["contact"]
    words = [f"Largest displacement in the last tenth of {periods:g} periods: {largest:.4g} mm."]
    words += [f"Contacts: {contacts}."]
    numbers = {"largest_displacement_mm": largest, "contacts": contacts}
    tell(as_json, words + kept(motion, output), numbers)


@app.command()
def response(
    machine_file: MachineFile,
    gap: Gap = None,
    starts: Annotated[int, typer.Option(min=1, help="Random starts at each frequency.")] = 96,
    output: Kept = None,
    workers: Workers = 2,
    as_json: AsJson = False,
):
    """Find all motions over the band, without the damper if no gap is given."""
    import numpy as np

    from impact_damper.data.datasets import is_settled
    from impact_damper.model.units import si_value
    from impact_damper.motions.response import frequency_response

    given, machine = read(machine_file)
    band = given["band"]
    ends = (si_value("band", band[end], "frequency") for end in ("first", "last"))
    system = machine, damper(given, machine, gap), np.linspace(*ends, band["points"])
    title = "Response" if sys.stderr.isatty() and not as_json else None
    found = frequency_response(*system, starts=starts, workers=workers, progress=title)
    rows = []
    words = ["Hz        largest displacement, mm (in brackets if not periodic): share of starts"]
    for i, hertz in enumerate(found["frequency"].values):
        each, row, told = found.isel(frequency=i), {"frequency_hz": float(hertz)}, []
        moved, shares = each["maximum_displacement"].values, each["motion_starts"].values / starts
        settled = is_settled(each)
        other = ~settled & (each["outcome"].values >= 0)
        for name, chosen, form in (("settled", settled, "{:.4g}"), ("other", other, "({:.4g})")):
            sizes = different(moved[chosen], shares[chosen])
            row[f"{name}_mm"] = list(sizes)
            row[f"{name}_share"] = list(sizes.values())
            told += [f"{form.format(size)}: {100 * sizes[size]:.0f} %" for size in sizes]
        rows.append(row)
        words.append(f"{hertz:<9.4g} {'  '.join(told)}")
    tell(as_json, words + kept(found, output), {"response": rows})


def different(sizes, shares, alike=1e-4):
    """Return {size: share}. Shares are added if sizes differ by at most the fraction `alike`."""
    found, last = {}, -1.0
    for size, share in sorted(zip(map(float, sizes), map(float, shares), strict=True)):
        if size > last * (1 + alike):
            last = size
        found[last] = found.get(last, 0.0) + share
    return found


@app.command()
def migrate(
    machine_file: MachineFile,
    output: Annotated[Path, typer.Option(help="Folder for data and plot.")] = "migration",
    workers: Workers = 2,
    force: Force = False,
    as_json: AsJson = False,
):
    """Find gaps with which switching the damper off leaves the machine in its small motion."""
    import numpy as np

    from impact_damper.command.machine_file import design_arguments
    from impact_damper.data.datasets import save
    from impact_damper.design.migration import migration
    from impact_damper.model.machine import describe_si
    from impact_damper.plot.maps import migration_map
    from impact_damper.plot.pages.render import check_folder
    from impact_damper.plot.style import save_figure

    given, machine = read(machine_file)
    values = design_arguments(given, workers)
    for name in ("tolerances", "absorber", "displacement_limit"):
        del values[name]
    check_folder(output, describe_si(machine), force)
    title = "Releases" if sys.stderr.isatty() and not as_json else None
    found = migration(machine, **values, progress=title)
    save(found, output / "migration.nc")
    save_figure(migration_map(found), output / "migration")
    sure = found["released_frequency"] >= found["sure_frequency"]
    times = found[["migration_time", "migration_bound"]].where(sure).max("released_frequency")
    columns = {
        "gap_mm": found["released_gap"],
        "sure_from_hz": found["sure_frequency"],
        "median_s": times["migration_time"],
        "bound_s": times["migration_bound"],
        "least_share": found["migration_share"].min("released_frequency"),
    }
    rows = []
    head = "gap, mm   sure from, Hz   median time, s   {:g} % within, s   least share of successes"
    words = [head.format(100 * values["share"])]
    for numbers in zip(*columns.values(), strict=True):
        row = [float(number) if np.isfinite(number) else None for number in numbers]
        rows.append(dict(zip(columns, row, strict=True)))
        sure, median, bound = (f"{each:.4g}" if each else "nowhere" for each in row[1:4])
        words.append(f"{row[0]:<9.4g} {sure:<15} {median:<16} {bound:<15} {100 * row[4]:.0f} %")
    words.append(f"The data and the plot: {output}")
    tell(as_json, words, {"migration": rows, "data": str(output / "migration.nc")})


@app.command()
def report(
    data: Annotated[
        Path, typer.Argument(exists=True, help="design.nc or evaluation.nc of this command.")
    ],
    output: Annotated[
        Path, typer.Option(help="Folder for the page; by default the folder of the data.")
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
):
    """Write the page of a finished design or evaluation again, from its data."""
    from impact_damper.data.datasets import load, parameters_of
    from impact_damper.plot.pages.render import check_folder

    found = load(data)
    if "promised_displacement" not in found:
        title = found.attrs["title"]
        raise ValueError(f"{data}: must be of a design or an evaluation; its title is {title}")
    check_folder(output or data.parent, parameters_of(found)["machine"], force)
    page = write_report(found, data, output or data.parent)
    tell(as_json, [f"The page: {page}"], {"page": str(page)})


def read(path):
    """Return the content of a machine's YAML file, and the `Machine` that it describes."""
    from impact_damper.command.machine_file import read_machine_file  # here: `--help` stays fast
    from impact_damper.model.machine import Machine

    given = read_machine_file(path)
    return given, Machine(**given["machine"])


def answer(decide, made, machine_file, file, force, as_json):
    """Call `decide`, save its result in `file`, write a page about the result, print the answer.

    Unless `force` is True, the folder of `file` must not hold data of a machine other than `made`.
    """
    from impact_damper.data.datasets import decode, save
    from impact_damper.model.machine import describe_si
    from impact_damper.plot import conclusion
    from impact_damper.plot.pages.render import check_folder

    check_folder(file.parent, describe_si(made), force)
    found = decide(progress=sys.stderr.isatty() and not as_json, folder=file.parent / "steps")
    found.attrs["input_file"] = machine_file.name
    save(found, file)
    page, words = write_report(found, file, file.parent), conclusion(found)
    sizes = "design_gap promised_displacement largest_bare_displacement tuned_displacement"
    numbers = {f"{name}_mm": float(found[name]) for name in sizes.split()}
    numbers |= {name: decode(found[name]).item() for name in ("decision", "limit_status")}
    numbers |= {"conclusion": words, "page": str(page), "data": str(file)}
    tell(as_json, [*words, f"The page: {page}"], numbers)


def damper(given, machine, gap):
    """Return a damper, or None if `gap` is None. `given` is the content of a machine's file."""
    from impact_damper.command.machine_file import design_arguments
    from impact_damper.design.task import Task

    if gap is None:
        return None
    values = design_arguments(given)
    values = {name: values[name] for name in ("mass", "restitution", "contact", "band", "mount")}
    task = Task(machine=machine, **values, gap=quantity(gap))
    return task.damper(task.gap)


def quantity(text):
    """Return the number that a text holds, or the text itself if it has a unit."""
    try:
        return float(text)
    except ValueError:
        return text.strip()


def write_report(data, file, folder):
    """Write a page about `data`, the dataset in `file`, into a folder. Return the page's path."""
    from impact_damper.plot.pages.render import write_page

    name = Path(data.attrs.get("input_file", file.name)).stem
    date = datetime.fromtimestamp(file.stat().st_mtime).date().isoformat()
    write_page(name, data, folder, file.name, date)
    return folder / "index.html"


def kept(data, output):
    """Unless `output` is None, save a dataset to this path. Return a list of messages."""
    if output is None:
        return []
    from impact_damper.data.datasets import save

    save(data, output)
    return [f"The data: {output}"]


def tell(as_json, words, numbers):
    """Print the lines `words`, or with `as_json` the dictionary `numbers` as a JSON object."""
    print(json.dumps(numbers) if as_json else "\n".join(words))


def run_app():
    """Run the command. If an argument is wrong, exit with a message and no traceback."""
    warnings.showwarning = lambda message, *rest: print(f"Warning: {message}", file=sys.stderr)
    try:
        app()
    except (TypeError, ValueError, OSError) as error:
        sys.exit(f"Error: {error}")
    except SystemExit as end:
        if end.code == INTERRUPTED:
            words = "Finished steps of a design are kept; the same command continues the design."
            print(f"\nInterrupted. {words}", file=sys.stderr)
        raise
