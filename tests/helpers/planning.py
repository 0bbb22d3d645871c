"""What jobs the workflow has for a configuration, with their parameters and inputs.

Snakemake reads the rules once; what they say of their jobs is then asked for one configuration
after the other, which takes milliseconds in place of the seconds of a dry run.
"""

import json
import re
from contextlib import chdir
from functools import cache
from pathlib import Path
from typing import NamedTuple

from snakemake.api import SnakemakeApi
from snakemake.io import apply_wildcards, is_flagged
from snakemake.iocontainers import Wildcards
from snakemake.settings.types import (
    ConfigSettings,
    OutputSettings,
    Quietness,
    ResourceSettings,
)


class Job(NamedTuple):
    """What Snakemake compares of a job, and the files by which it depends on others."""

    params: frozenset
    inputs: frozenset
    needs: frozenset


class Planner:
    """The rules of a project, asked for the jobs of any configuration."""

    def __init__(self, project):
        self.project = project
        with SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api:
            opened = api.workflow(
                resource_settings=ResourceSettings(cores=1),
                config_settings=ConfigSettings(),
                snakefile=project / "Snakefile",
                workdir=project,
            )
            self.workflow = opened._workflow
        self.known = self.workflow.globals
        self.results = self.known["config"]["results"]
        self._rule_of = cache(self._rule_of)
        self._compared = cache(self._compared)

    def jobs(self, config) -> dict:
        """All jobs by name, as `free/h215`; none of them is started."""
        self.known["config"] = json.loads(json.dumps(config, sort_keys=True))
        with chdir(self.project):
            return self._jobs(config)

    def _jobs(self, config):
        paths = [path for stage in self.known["STAGES"] for path in self.known["data"](stage)]
        paths += [path for name in config["studies"] for path in self._chunks(name)]
        paths += [f"<results>/figures/{name}.png" for name in config["figures"]]
        paths += [f"<results>/tables/{name}.csv" for name in self.known["TABLES"]]
        jobs = {name_of(path): self._job(*self._rule_of(self._kind(path), path)) for path in paths}
        return jobs | {"captions": self._job(self._rule("captions"), Wildcards())}

    def _chunks(self, study):
        """Files that a study is gathered from."""
        rule = self._rule("study_grid")
        wildcards = Wildcards(fromdict={"study": study})
        found = {path for item in rule.input for path in _files(item, wildcards)}
        return sorted(path for path in found if "/study_chunks/" in path)

    def _rule(self, name):
        return self.workflow.get_rule(name)

    def _kind(self, path):
        """Kind of a figure: its rule takes the figures that had the kind when rules were read."""
        figure = re.search(r"/figures/(\w+)\.png$", path)
        return figure and self.known["config"]["figures"][figure[1]]["kind"]

    def _rule_of(self, kind, path):
        if kind:
            return self._rule(f"draw_{kind}"), Wildcards(fromdict={"figure": Path(path).stem})
        path = path.replace("<results>", self.results)
        (rule,) = (rule for rule in self.workflow.rules if rule.is_producer(path))
        return rule, Wildcards(fromdict=rule.get_wildcards(path))

    def _compared(self, rule):
        """Parameters that count; what is derived from the outputs does not."""
        return [item for item in rule.params if not rule._is_deriving_function(item)]

    def _job(self, rule, wildcards):
        params = {
            repr(item(wildcards) if callable(item) else item) for item in self._compared(rule)
        }
        inputs, ancient = set(), set()
        for item in rule.input:
            files = _files(item, wildcards)
            inputs |= files
            ancient |= files if is_flagged(item, "ancient") else set()
        inputs = frozenset(path.replace("<results>", self.results) for path in inputs)
        return Job(frozenset(params), inputs, inputs - ancient)


def _files(item, wildcards):
    """Files that an entry of `input` stands for."""
    given = item._file.callable if is_flagged(item, "unpack") else item
    if not callable(given):
        return {apply_wildcards(item, wildcards) if "{" in item else str(item)}
    files = given(wildcards)
    lists = files.values() if isinstance(files, dict) else [files]
    return {path for paths in lists for path in paths}


@cache
def name_of(path):
    """Name of the job that makes a file of the results."""
    path = Path(path)
    return "captions" if path.suffix == ".rst" else "/".join(path.with_suffix("").parts[1:])


def reruns(before, after, edited=frozenset()) -> set:
    """Jobs that run after an edit of the configuration, or of files, and those that follow them."""
    found = {
        name
        for name, job in after.items()
        if name not in before or job != before[name] or job.needs & edited
    }
    new = found
    while new:
        new = {
            name
            for name, job in after.items()
            if name not in found and any(name_of(path) in new for path in job.needs)
        }
        found |= new
    return found
