"""A check of the folder for results, made before anything is computed."""

from impact_damper.data.datasets import load, parameters_of
from impact_damper.data.whole_files import BrokenFileError, whole
from impact_damper.plot.pages.render import GENERATOR


def check_folder(folder, machine, force) -> None:
    """Raise OSError unless files can be written into a folder.

    Without `force` the folder must hold no foreign `index.html` and no data of another machine.
    """
    probe = folder / "index.html.check"
    with whole(probe) as part:
        part.touch()
    probe.unlink()
    if force:
        return
    page = folder / "index.html"
    if page.exists() and GENERATOR not in page.read_text(errors="replace")[:1000]:
        raise FileExistsError(
            f"{page} is no page of impact-damper: choose another --output, or replace it by --force"
        )
    for path in (folder / "design.nc", folder / "evaluation.nc"):
        try:
            held = parameters_of(load(path)).get("machine")
        except (FileNotFoundError, BrokenFileError):
            continue
        if held != machine:
            raise FileExistsError(
                f"{path} is of another machine: choose another --output, or replace it by --force"
            )
