"""The class `Claim`, a claim of the paper. Its verdict is computed from datasets."""

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
    """Return a share from 0 to 1 as text: "all", "none" or a percentage."""
    return {1.0: "all", 0.0: "none"}.get(float(share)) or percent(share, digits)


def rounding(distance) -> str:
    """Return in words whether a printed number is rounded right.

    `distance` is the error of the number, divided by half a unit of its last digit.
    """
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
    """The range from `least` to `most` in which the number called `name` must lie."""

    name: str
    least: float
    most: float

    @classmethod
    def read(cls, text):
        """Return the bound that a text states, such as "size <= 0.05" or "0.9 <= x <= 1.1"."""
        parts = text.split(" <= ")
        (name,) = (each for each in parts if each.isidentifier())
        least, most = parts[: parts.index(name)], parts[parts.index(name) + 1 :]
        return cls(name, *map(float, least or [-math.inf]), *map(float, most or [math.inf]))

    def holds(self, values) -> bool | None:
        """Return whether `values[name]` is in the range, or None if the number is NaN."""
        value = values[self.name]
        return None if math.isnan(value) else self.least <= value <= self.most

    def __str__(self):
        if math.isinf(self.least):
            return f"at most {self.most:g}"
        if math.isinf(self.most):
            return f"at least {self.least:g}"
        return f"from {self.least:g} to {self.most:g}"


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, and the bounds that decide whether it is reproduced.

    `number` is "1" to "19" for claims, or "S1" to "S6" for misprints and omissions.
    `evidence(datasets)` returns a dict of numbers, or raises `Missing`. Numbers that the data do
    not determine are NaN. `reading` says how vague words of the paper are read. `finding` is a
    template for a text with the numbers, and fits every verdict.

    `required` and `full_agreement` are dicts: bound as text -> meaning of the bounded number, or
    None if an earlier bound gives the meaning. If a required bound fails, the claim is not
    reproduced. If only bounds for full agreement fail, the claim is reproduced with a difference.
    `figures` are names of figures, the most important first. `verdicts` is a dict: verdict ->
    words that are printed in its place.
    """

    number: str
    evidence: Callable[[dict], dict]
    claim: str
    source: str
    reading: str
    finding: str
    required: Mapping[str, str | None]
    full_agreement: Mapping[str, str | None] = field(default_factory=dict)
    figures: Sequence[str] = ()
    verdicts: Mapping[str, str] = field(default_factory=dict)

    @property
    def meanings(self) -> dict:
        """A dict: name of a number that has a bound -> meaning of the number."""
        texts = {**self.required, **self.full_agreement}
        return {Bound.read(bound).name: words for bound, words in texts.items() if words}

    def verdict(self, values) -> str:
        """Return the verdict on the claim, such as "reproduced", for the numbers `values`."""
        required, wished = (
            [Bound.read(text).holds(values) for text in bounds]
            for bounds in (self.required, self.full_agreement)
        )
        if False in required:
            return NOT_REPRODUCED
        if None in required + wished:
            return NOT_DECIDABLE
        return DIFFERENT if False in wished else REPRODUCED

    def criterion(self) -> str:
        """Return a text that lists the bounds of the claim and what the bounded numbers mean."""
        parts = []
        for lead, texts in (
            ("Required", self.required),
            ("For full agreement", self.full_agreement),
        ):
            bounds = map(Bound.read, texts)
            words = "; ".join(f"{self.meanings[bound.name]}, {bound}" for bound in bounds)
            parts += [f"{lead}: {words}."] if words else []
        return " ".join(parts)

    def sentences(self, values) -> str:
        """Return the finding as text, or a text that says which numbers are unknown (NaN)."""
        if self.verdict(values) != NOT_DECIDABLE:
            return " ".join(SENTENCES.from_string(self.finding).render(values).split())
        unknown = [words for name, words in self.meanings.items() if math.isnan(values[name])]
        return f"The data do not determine: {'; '.join(unknown)}."

    def judge(self, datasets) -> dict:
        """Return the row of this claim in the table of claims, as a dict."""
        try:
            values = self.evidence(datasets)
            verdict, finding = self.verdict(values), self.sentences(values)
            evidence = "; ".join(
                f"{words}: {number(values[name], 4)}" for name, words in self.meanings.items()
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
