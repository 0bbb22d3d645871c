"""Errors of methods against counted work, on one scene."""

from impact_damper.workflow.job import begin

begin(snakemake)

import json
from collections import ChainMap
from pathlib import Path

from impact_damper.data.datasets import save
from impact_damper.rivals.comparison_scenes import ComparisonScene
from impact_damper.stages.accuracy import error_against_work
from impact_damper.system.parameters import Damper, Oscillator

job = dict(ChainMap(*snakemake.params))
settings, damper = job.pop("settings"), job.pop("damper")
scene = ComparisonScene(
    oscillator=Oscillator(**job.pop("oscillator")),
    damper=None if damper is None else Damper(**damper),
    **job,
)
references = json.loads(Path(snakemake.input.references).read_text())
save(
    error_against_work(scene, settings, references.get(scene.name)),
    snakemake.output[0],
)
