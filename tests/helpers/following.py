"""Which jobs follow from an edit, by the flow of data that is written down."""

import re
from fnmatch import fnmatchcase
from functools import cache
from modulefinder import ModuleFinder
from pathlib import Path

from helpers.data_flow import (
    DRAWN,
    OTHER_STIFFNESS,
    OVER_FREQUENCY,
    READERS,
    SCRIPTS,
    SETTLING,
    STAGES,
    TABLES,
)
from impact_damper.system.parameters import SYMBOLS

MADE_BY = re.compile(r"^def (\w+)\(datasets\)", re.MULTILINE)
DRAWN_BY = re.compile(r"^def draw_(\w+)\(\*, ([\w, ]+)\)", re.MULTILINE)


@cache
def functions(folder, pattern):
    """Groups of a pattern that are found in the files of a folder, each after its file."""
    return [
        (path, *found.groups())
        for path in Path(folder).glob("*.py")
        for found in pattern.finditer(path.read_text())
    ]


class Flow:
    """What follows from what for one configuration of a project."""

    def __init__(self, project, config):
        self.config, self.imported = config, {}
        # The arguments of a drawing function are the stages that it draws.
        self.drawn = {
            kind: stages.split(", ")
            for _, kind, stages in functions(project / "src/impact_damper/figures", DRAWN_BY)
        }
        self.needs = {job: set() for job in self._computed()}
        for job in self.needs:
            self.needs[job] = self._computed_from(job)
        for table, stages in TABLES.items():
            self.needs[f"tables/{table}"] = set(self.like(*(f"{s}/*" for s in stages.split())))
        for name, figure in config["figures"].items():
            self.needs[f"figures/{name}"] = set(self._pictured(figure))
        self.needs["captions"] = set()

    def _computed(self):
        for section, stages in STAGES.items():
            for name, entry in self.config[section].items():
                for stage in entry.get("stages", stages):
                    yield from self._parts(stage, name)

    def _parts(self, stage, name):
        """Jobs of an entry: one, or as many as there are chunks."""
        if stage != "study_chunks":
            return [f"{stage}/{name}"]
        count = self.config["chunks"]
        return [f"{stage}/{name}/{k}-of-{count}" for k in range(1, count + 1)]

    def _computed_from(self, job):
        stage, _, name = job.partition("/")
        if stage == "free_branches":
            return {f"free/{name}"}
        if stage == "branches":
            return set(self.like(f"response/{name}", f"subharmonic/{name}"))
        if stage == "studies":
            return set(self._parts("study_chunks", name))
        return set()

    def _pictured(self, figure):
        for stage in self.drawn.get(figure["kind"], []):
            for name in figure["data"]:
                if stage == "free_branches" and figure["kind"] != "free":
                    name = self.config["curves"][name]["oscillator"]
                yield from self.like(f"{stage}/{name}")

    def like(self, *patterns):
        """Jobs of some names."""
        return [job for job in self.needs if any(fnmatchcase(job, p) for p in patterns)]

    def following(self, jobs):
        """Jobs, and all that use what they make."""
        found = new = set(jobs)
        while new:
            new = {job for job, needs in self.needs.items() if needs & new} - found
            found = found | new
        return found

    def of(self, path):
        """All jobs that depend on a value of the configuration, given the keys that lead to it."""
        if "stages" in path:
            # a stage that is left out: it does not run, but what used it does
            left_out = f"{self._at(path)}/{path[1]}"
            return self.following({left_out}) - {left_out}
        return self.following(self.readers(path))

    def of_file(self, project, edited):
        """All jobs that depend on what stands in a file."""
        if edited == "requirements.lock":
            return set(self.needs)
        if Path(edited).parent == Path("workflow/report"):
            kinds = {figure["kind"] for figure in self.config["figures"].values()}
            return {"captions"} if Path(edited).stem in kinds else set()
        if edited == "workflow/resources/references.json":
            return self.following(self.like("accuracy/*"))
        return self.following(self._running(project, edited))

    def _running(self, project, edited):
        """Jobs that run code of a file."""
        for script, jobs in SCRIPTS.items():
            path = project / "workflow/scripts" / f"{script}.py"
            for job in self.like(jobs):
                others = script == "table" and job == "tables/claims"
                kind = self._kind(job)
                others |= bool(kind) and (kind == "schematic") != (script == "draw_schematic")
                called = self._called(project, script, job)
                if not others and edited in self._imported(project, path, *called):
                    yield job

    def _kind(self, job):
        stage, _, name = job.partition("/")
        return stage == "figures" and self.config["figures"][name]["kind"]

    def _called(self, project, script, job):
        """The module that the scripts of many figures and of many tables look up by name."""
        package = project / "src/impact_damper"
        if script == "draw":
            found = functions(package / "figures", DRAWN_BY)
            return [path for path, kind, _ in found if kind == self._kind(job)]
        if script == "table":
            return [path for path, name in functions(package, MADE_BY) if f"tables/{name}" == job]
        return []

    def _imported(self, project, *paths):
        """Files that Python imports for some others."""
        if paths not in self.imported:
            finder = ModuleFinder(path=[str(project / "src")])
            for path in paths:
                finder.run_script(str(path))
            files = {module.__file__ for module in finder.modules.values() if module.__file__}
            found = {Path(file).relative_to(project).as_posix() for file in [*files, *paths]}
            # They run in any case but decide nothing: these hold no names that others take.
            self.imported[paths] = found - {
                "src/impact_damper/__init__.py",
                *(
                    f"src/impact_damper/{part}/__init__.py"
                    for part in ("claims", "figures", "rivals")
                ),
            }
        return self.imported[paths]

    def _at(self, path):
        value = self.config
        for key in path:
            value = value[key]
        return value

    def readers(self, path):
        """Jobs that read a value themselves."""
        section, *inner = path
        if section == "results":
            return set(self.needs)
        if section == "figures":
            drawn = {f"figures/{inner[0]}"} if inner[1] in ("kind", "data") else set()
            return drawn | {"captions"}
        return set(self._computing(path)) | self._captions(path)

    def _computing(self, path):
        section, *inner = path
        if section == "contact_stiffness":
            yield from self._in_contact()
            return
        served = self.config["settling"]["scene"]
        if path == ("scenes", served, "tolerance"):
            yield from self.like(*SETTLING.split())
        dotted = ".".join(map(str, path))
        found = [key for key in READERS if fnmatchcase(dotted, key)]
        if found:
            jobs = READERS[max(found, key=len)].format(*inner).split()
            yield from self.like(*jobs)
        else:
            yield from self._stages(section, inner[0])
        if section == "oscillators":
            yield from self._with_oscillator(*inner[:2])

    def _stages(self, section, name):
        return self.like(*(job for stage in STAGES[section] for job in self._parts(stage, name)))

    def _with_oscillator(self, oscillator, key):
        for section in STAGES:
            for name, entry in self.config[section].items():
                if entry.get("oscillator") == oscillator:
                    for job in self._stages(section, name):
                        if key != "frequencies" or job.split("/")[0] in OVER_FREQUENCY:
                            yield job

    def _in_contact(self):
        for section in set(STAGES) - set(OTHER_STIFFNESS):
            for name, entry in self.config[section].items():
                if section != "scenes" or "mass_ratio" in entry:
                    yield from self._stages(section, name)

    def _captions(self, path):
        """The captions, if that of a figure which draws an entry holds the value."""
        for figure in self.config["figures"].values():
            section = DRAWN.get(figure["kind"], figure["kind"])
            for name in figure["data"] if section in self.config else []:
                if self._told(path, section, name, figure["kind"]):
                    return {"captions"}
        return set()

    def _told(self, path, section, name, kind):
        entry = self.config[section][name]
        stiffness = kind in ("harmonics", "contact_model")
        if path[0] == "contact_stiffness":
            return stiffness and path[0] not in entry and "mass_ratio" in entry
        if path[0] == "oscillators":
            mine = name if section == "oscillators" else entry.get("oscillator")
            return path[1] == mine and path[2] in SYMBOLS
        if path[:2] != (section, name):
            return False
        if path[2] == "oscillator":
            return True
        if kind == "design_rules":
            return path[2] in ("restitutions", "contact_stiffnesses", "frequencies")
        if kind == "studies":
            return path[2] in ("restitution", "frequency")
        return path[2] in SYMBOLS and (stiffness or path[2] != "contact_stiffness")
