"""A claim of the paper: the measures that decide it, their required values, and the verdict.

A measure is a number computed from datasets, with the bounds that the claim requires. Misprints and
omissions of the paper are treated as claims that the print is correct.

A stage is a step of the workflow.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

REPRODUCED = "reproduced"
DIFFERENT = "reproduced with a difference"
NOT_REPRODUCED = "not reproduced"
NOT_DECIDABLE = "not decidable"
# How tables print each verdict.
# PLAIN: on a claim.
# SLIP: on a misprint.
# PART: on initial conditions of which too few numbers are printed.
# GAP: on values that had to be chosen because none are printed.
PLAIN = {word: word for word in (REPRODUCED, DIFFERENT, NOT_REPRODUCED, NOT_DECIDABLE)}
SLIP = PLAIN | {
    REPRODUCED: "the print is consistent",
    DIFFERENT: "the print is nearly right",
    NOT_REPRODUCED: "a printed value is wrong",
}
PART = SLIP | {NOT_REPRODUCED: "the print is incomplete"}
GAP = PLAIN | {
    REPRODUCED: "the values chosen are consistent",
    DIFFERENT: "the values chosen are nearly consistent",
    NOT_REPRODUCED: "the values chosen are not consistent",
}


class Missing(LookupError):
    """A dataset that a claim needs does not exist, or lacks a number that the claim needs."""


def readable(value) -> str:
    """Return a number with four significant digits; "none" for NaN."""
    return "none" if math.isnan(value) else f"{value:.4g}"


@dataclass(frozen=True)
class Measure:
    """One number of the evidence for a claim.

    Attributes
    ----------
    name : str
        Key of the number in the dictionary that `Claim.evidence` returns.
    description : str
        What the number measures.
    least, most : float
        Bounds that the claim requires. A measure without bounds does not affect the verdict.
    decisive : bool
        True: a value outside the bounds refutes the claim. False: such a value makes the verdict
        "reproduced with a difference".
    """

    name: str
    description: str
    least: float = -math.inf
    most: float = math.inf
    decisive: bool = False

    @property
    def requirement(self) -> str:
        """The bounds as text; "" without bounds."""
        if math.isfinite(self.least) and math.isfinite(self.most):
            return f"from {self.least:g} to {self.most:g}"
        bounds = [("at least", self.least), ("at most", self.most)]
        return "".join(f"{word} {bound:g}" for word, bound in bounds if math.isfinite(bound))

    def holds(self, value) -> bool:
        """Return whether a value is within the bounds; False for NaN."""
        return self.least <= value <= self.most


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, or a misprint taken as the statement that the print is correct.

    Attributes
    ----------
    number : str
        "1" to "19", or "S1" to "S6" for misprints and omissions.
    text : str
        The statement of the paper, shortened.
    source : str
        Section and figure of the paper.
    interpretation : str
        Meaning given to vague words of the statement.
    measures : tuple of Measure
        The numbers that decide the claim. A name may occur twice, with a decisive bound and a
        sharper one.
    evidence : callable
        Takes all datasets, a dict keyed by stage of dicts keyed by name, and returns a dict with
        the value of each measure; NaN if the datasets do not determine it. May raise `Missing`.
    finding : callable
        Takes the values of the measures as keyword arguments, and returns sentences that say what
        the data show. Values of measures with bounds must not be NaN. The sentences must be true
        for every verdict.
    figures : tuple of str
        Names of the figures that show the claim, the most important one first; empty if no figure
        shows it.
    words : dict of str
        How tables print each verdict.
    """

    number: str
    text: str
    source: str
    interpretation: str
    measures: tuple[Measure, ...]
    evidence: Callable[[dict], dict]
    finding: Callable[..., str]
    figures: tuple[str, ...] = ()
    words: Mapping[str, str] = field(default_factory=PLAIN.copy)

    def verdict(self, values) -> str:
        """Return the verdict for a dict with the values of the measures.

        A decisive measure out of bounds refutes the claim. Otherwise, if the value of a measure
        with bounds is NaN, the claim is not decidable. Otherwise a measure out of bounds that is
        not decisive makes the verdict "reproduced with a difference".
        """
        bounded = [measure for measure in self.measures if measure.requirement]
        known = [measure for measure in bounded if not math.isnan(values[measure.name])]
        failed = [measure for measure in known if not measure.holds(values[measure.name])]
        if any(measure.decisive for measure in failed):
            return NOT_REPRODUCED
        if len(known) < len(bounded):
            return NOT_DECIDABLE
        return DIFFERENT if failed else REPRODUCED

    def criterion(self) -> str:
        """Return the requirements as text, first the decisive ones."""
        parts = []
        for lead, decisive in (("Required", True), ("For full agreement", False)):
            required = [
                f"{measure.description}, {measure.requirement}"
                for measure in self.measures
                if measure.requirement and measure.decisive == decisive
            ]
            if required:
                parts.append(f"{lead}: {'; '.join(required)}.")
        return " ".join(parts)

    def sentence(self, values) -> str:
        """Return what the data show; if the claim is not decidable, which numbers are unknown."""
        if self.verdict(values) != NOT_DECIDABLE:
            return self.finding(**values)
        unknown = [
            measure.description
            for measure in self.measures
            if measure.requirement and math.isnan(values[measure.name])
        ]
        return f"The data do not determine: {'; '.join(dict.fromkeys(unknown))}."

    def judge(self, datasets) -> dict:
        """Return the row of the claim in the table of claims, a dict keyed by column.

        `datasets` is the argument of `evidence`.
        """
        descriptions = {measure.name: measure.description for measure in self.measures}
        try:
            values = self.evidence(datasets)
            verdict, finding = self.verdict(values), self.sentence(values)
            evidence = "; ".join(
                f"{text}: {readable(values[name])}" for name, text in descriptions.items()
            )
        except Missing as missing:
            verdict, finding, evidence = NOT_DECIDABLE, f"{missing}.", ""
        return {
            "number": self.number,
            "claim": self.text,
            "verdict": self.words[verdict],
            "finding": finding,
            "figures": " ".join(self.figures),
            "source": self.source,
            "interpretation": self.interpretation,
            "criterion": self.criterion(),
            "evidence": evidence,
        }
