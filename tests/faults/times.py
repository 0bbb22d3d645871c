"""Two runs at once, and a clock that was set back.

A trial cannot set the computer's clock, so it changes the dates of files: after a clock was set
back by a day, files written before seem to be from tomorrow.
"""

import os
import time

from .project import DATA, LOCKED, expect

DAY = 86400


def two_runs(context):
    """Yield a trial with two runs at once in one folder."""

    def trial():
        project = context.fresh("two-runs")
        both = [project.start()]
        time.sleep(0.25 * context.seconds)
        both.append(project.start())
        told = [process.communicate()[0] for process in both]
        codes = [process.returncode for process in both]
        expect(codes[0] == 0, f"the first run is disturbed: {told[0][-500:]}")
        expect(codes[1] and LOCKED in told[1], f"the second is not refused: {told[1][-500:]}")
        project.expect_same(context.undisturbed)
        return "nothing: the first run finishes, the second is refused"

    yield "two runs at once", trial


def _ahead(paths):
    """Date files a day into the future."""
    for path in paths:
        if path.is_file():
            os.utime(path, (time.time() + DAY,) * 2)


def clock_set_back(context):
    """Yield trials in which results seem to be from tomorrow."""

    def finished():
        project = context.finished("clock")
        _ahead((project.folder / "results").rglob("*"))
        return project.recover(context.undisturbed, lost=0)

    def halfway():
        project = context.finished("clock-halfway")
        _ahead((project.folder / "results").rglob("*"))
        for path in (project.folder / "results").rglob("*"):
            if path.suffix in (".csv", ".md", ".png", ".pdf", ".rst"):
                path.unlink()
        return project.recover(context.undisturbed, lost=0)

    def edited():
        project = context.finished("clock-edited")
        _ahead((project.folder / "results").rglob("*"))
        script = project.folder / "workflow/scripts/stage.py"
        script.write_text(script.read_text() + "# A word.\n")
        plan = project.planned()
        expect(
            any("clearance" in line for line in plan),
            f"the job of the edited script is not planned: {plan}",
        )
        before = project.written()[DATA]
        code, told = project.run()
        expect(code == 0, told[-500:])
        expect(project.written()[DATA] != before, "the job of the edited script did not run")
        project.expect_same(context.undisturbed)
        return "run again"

    yield "clock set back after a run", finished
    yield "clock set back between data and figures", halfway
    yield "clock set back, then a script edited", edited


TRIALS = [two_runs, clock_set_back]
