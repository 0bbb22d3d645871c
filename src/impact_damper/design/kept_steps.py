"""Steps of a design that are kept in files, so that an interrupted design can be continued."""

import hashlib
import json
from pathlib import Path

from impact_damper.data.datasets import load, save
from impact_damper.data.whole_files import BrokenFileError


class KeptSteps:
    """Datasets of steps, each kept in a file of a folder.

    Parameters
    ----------
    folder : str or pathlib.Path, optional
        Without a folder nothing is kept.
    made : dict
        All inputs of the design. A step is computed again if its file was made from other inputs or
        by another version of this package's source files.
    """

    def __init__(self, folder, made):
        self.folder = None if folder is None else Path(folder)
        self.made = json.dumps(made | {"sources": _sources()}, sort_keys=True)

    def step(self, name, compute):
        """Return the dataset of a step, read from its file or else computed and kept.

        Parameters
        ----------
        name : str
        compute : callable
            Returns the dataset.
        """
        if self.folder is None:
            return compute()
        path = self.folder / f"{name}.nc"
        try:
            kept = load(path)
            if kept.attrs.get("made") == self.made:
                return kept
        except (FileNotFoundError, BrokenFileError):
            pass  # computed below
        self.folder.mkdir(parents=True, exist_ok=True)
        save(compute().assign_attrs(made=self.made, source="impact-damper"), path)
        return load(path)


def _sources():
    """Return a digest of all source files of the package."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
