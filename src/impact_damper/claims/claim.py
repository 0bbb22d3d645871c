"""A claim of the paper: the measures that decide it, their required values, and the verdict."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

REPRODUCED = "reproduced"
DIFFERENT = "reproduced with a difference"
NOT_REPRODUCED = "not reproduced"
NOT_DECIDABLE = "not decidable"
PLAIN = {word: word for word in (REPRODUCED, DIFFERENT, NOT_REPRODUCED, NOT_DECIDABLE)}
# Words for the verdict on a misprint or omission, keyed by the verdict on the claim that the print
# is correct; on initial conditions of too few numbers; on values chosen because none are printed.
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
    """A dataset that a claim needs does not exist, or lacks what the claim needs."""


def readable(value) -> str:
    """A number with four significant digits; "none" for NaN."""
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
        """The bounds as text, "" without bounds."""
        if math.isfinite(self.least) and math.isfinite(self.most):
            return f"from {self.least:g} to {self.most:g}"
        bounds = [("at least", self.least), ("at most", self.most)]
        return "".join(f"{word} {bound:g}" for word, bound in bounds if math.isfinite(bound))

    def holds(self, value) -> bool:
        """Whether a value is within the bounds; False for NaN."""
        return self.least <= value <= self.most


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, or a misprint taken as the statement that the print is correct.

    Attributes
    ----------
    number : str
        "1" to "19", or "S1" to "S6" for misprints and omissions.
    text : str
        The statement, shortened.
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
        Takes these values as keyword arguments, the bounded ones known, and returns sentences that
        say what the data show, true whatever the verdict is.
    figures : tuple of str
        Names of the figures that show it, the most telling one first; empty for numbers alone.
    words : dict of str
        Keyed by verdict: how tables print it.
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
        """Verdict for the values of the measures.

        A decisive measure out of bounds refutes the claim. Otherwise an unknown value of a bounded
        measure leaves the claim undecided, and any other measure out of bounds is a difference.
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
        """The requirements as text, first the decisive ones."""
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
        """What the data show, with numbers; or which numbers they do not determine."""
        if self.verdict(values) != NOT_DECIDABLE:
            return self.finding(**values)
        unknown = [
            measure.description
            for measure in self.measures
            if measure.requirement and math.isnan(values[measure.name])
        ]
        return f"The data do not determine: {'; '.join(dict.fromkeys(unknown))}."

    def judge(self, datasets) -> dict:
        """Row of the claim in the table of claims."""
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
