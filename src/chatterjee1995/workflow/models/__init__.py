"""Models (pydantic) of the configuration, a file for each subject; `Configuration` is the whole.

A model states the keys of a section as fields, with types, bounds and meanings; `values` and
`system` make the types. Its method `contradictions` checks conditions between keys. Messages about
wrong values and the reference of the configuration (`python -m
chatterjee1995.workflow.models`) come from the same fields. In most sections the user chooses the
names of the entries; each file lists its sections of this kind in `SECTIONS`.
"""

from pydantic import create_model

from chatterjee1995.workflow.models import (
    balance,
    contact,
    figures,
    methods,
    motions,
    studies,
)
from chatterjee1995.workflow.models.settings import (
    RESULTS,
    SEED,
    Controller,
    Points,
    Search,
    Settling,
)
from chatterjee1995.workflow.models.system import CONTACT_STIFFNESS, Oscillators
from impact_damper.command import machine_entry
from impact_damper.command.section import Section
from impact_damper.command.values import count, entries

SUBJECTS = (motions, balance, contact, methods, studies, machine_entry, figures)
ENTRIES = {"oscillators": Oscillators} | {
    name: model for subject in SUBJECTS for name, model in subject.SECTIONS.items()
}


class Settings(Section):
    """Settings that hold for all stages."""

    results: RESULTS
    seed: SEED
    contact_stiffness: CONTACT_STIFFNESS
    chunks: count("number of jobs into which a study is divided", least=1, most=100000)
    points: Points
    search: Search
    settling: Settling
    controller: Controller
    comparison: methods.Comparison


Configuration = create_model(
    "Configuration",
    __base__=Settings,
    **{name: entries(model) for name, model in ENTRIES.items()},
)
