"""A claim of the paper as `claims.yaml` states it, and its verdict from the numbers of the data.

Misprints and omissions of the paper, S1 to S6, are claims that the print is correct.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from jinja2 import Environment, StrictUndefined

from chatterjee1995.reading.datasets import Missing
from chatterjee1995.tables.files import in_words
from impact_damper.model.text import number, percent

REPRODUCED = "reproduced"
DIFFERENT = "reproduced with a difference"
NOT_REPRODUCED = "not reproduced"
NOT_DECIDABLE = "not decidable"


def part(share, digits=2) -> str:
    """Return a share for a sentence that goes on with "of the": "all", "none" or a percentage."""
    return {1.0: "all", 0.0: "none"}.get(float(share)) or percent(share, digits)


def rounding(distance) -> str:
    """Return words for a printed number and its distance in half units of its last digit."""
    return "a right rounding" if distance <= 1 else "not a rounding"


SENTENCES = Environment(undefined=StrictUndefined)
SENTENCES.filters |= {
    "number": number,
    "percent": percent,
    "part": part,
    "rounding": rounding,
    "entry": in_words,
}
SENTENCES.tests["known"] = lambda value: not math.isnan(value)


class Bound(NamedTuple):
    """The values that a claim requires of one of its numbers."""

    name: str
    least: float
    most: float

    @classmethod
    def read(cls, text):
        """Return the bound of a text such as "size <= 0.05", "1 <= stable" or "0.9 <= x <= 1.1"."""
        parts = text.split(" <= ")
        (name,) = (each for each in parts if each.isidentifier())
        least, most = parts[: parts.index(name)], parts[parts.index(name) + 1 :]
        return cls(name, *map(float, least or [-math.inf]), *map(float, most or [math.inf]))

    def holds(self, value) -> bool:
        """Return whether a value is within the bound; False for NaN."""
        return self.least <= value <= self.most

    def __str__(self):
        if math.isinf(self.least):
            return f"at most {self.most:g}"
        if math.isinf(self.most):
            return f"at least {self.least:g}"
        return f"from {self.least:g} to {self.most:g}"


@dataclass(frozen=True)
class Claim:
    """A statement of the paper.

    Attributes
    ----------
    number : str
        "1" to "19", or "S1" to "S6".
    evidence : callable
        Takes all datasets, keyed by stage and name, and returns the values of `numbers`, NaN if the
        data do not determine them, and other values for the finding. May raise `Missing`.
    claim, source, reading : str
        The statement, shortened; section and figure of the paper; our meaning of vague words.
    finding : str
        Template of the sentences that say what the data show, true for every verdict.
    numbers : dict of str
        What each number measures.
    required, full_agreement : sequence of str
        Bounds without which the claim is refuted, or reproduced with a difference only.
    figures : sequence of str
        Names of the figures that show the claim, the most important one first.
    verdicts : dict of str
        Words for verdicts in place of the usual ones.
    """

    number: str
    evidence: Callable[[dict], dict]
    claim: str
    source: str
    reading: str
    finding: str
    numbers: Mapping[str, str]
    required: Sequence[str]
    full_agreement: Sequence[str] = ()
    figures: Sequence[str] = ()
    verdicts: Mapping[str, str] = field(default_factory=dict)

    @property
    def bounds(self) -> list:
        """Pairs of a bound and whether it is required, first the required ones."""
        return [(Bound.read(text), True) for text in self.required] + [
            (Bound.read(text), False) for text in self.full_agreement
        ]

    def verdict(self, values) -> str:
        """Return the verdict for the values of the numbers.

        An unknown number leaves the claim open, unless another number refutes it.
        """
        unknown = any(math.isnan(values[bound.name]) for bound, _ in self.bounds)
        failed = [
            required
            for bound, required in self.bounds
            if not math.isnan(values[bound.name]) and not bound.holds(values[bound.name])
        ]
        if any(failed):
            return NOT_REPRODUCED
        if unknown:
            return NOT_DECIDABLE
        return DIFFERENT if failed else REPRODUCED

    def criterion(self) -> str:
        """Return all bounds as text."""
        parts = []
        for lead, chosen in (("Required", True), ("For full agreement", False)):
            texts = [
                f"{self.numbers[bound.name]}, {bound}"
                for bound, required in self.bounds
                if required == chosen
            ]
            if texts:
                parts.append(f"{lead}: {'; '.join(texts)}.")
        return " ".join(parts)

    def sentences(self, values) -> str:
        """Return what the data show; if the claim is not decidable, which numbers are unknown."""
        if self.verdict(values) != NOT_DECIDABLE:
            return " ".join(SENTENCES.from_string(self.finding).render(values).split())
        unknown = [
            self.numbers[bound.name] for bound, _ in self.bounds if math.isnan(values[bound.name])
        ]
        return f"The data do not determine: {'; '.join(dict.fromkeys(unknown))}."

    def judge(self, datasets) -> dict:
        """Return the row of the claim in the table of claims."""
        try:
            values = self.evidence(datasets)
            verdict, finding = self.verdict(values), self.sentences(values)
            evidence = "; ".join(
                f"{text}: {number(values[name], 4)}" for name, text in self.numbers.items()
            )
        except Missing as missing:
            verdict, finding, evidence = NOT_DECIDABLE, f"{missing}.", ""
        return {
            "number": self.number,
            "claim": self.claim,
            "verdict": self.verdicts.get(verdict, verdict),
            "finding": finding,
            "figures": " ".join(self.figures),
            "source": self.source,
            "interpretation": self.reading,
            "criterion": self.criterion(),
            "evidence": evidence,
        }
