"""A claim of the paper: the numbers that decide it, what they must be, and the verdict."""

import math
from collections.abc import Callable
from dataclasses import dataclass

REPRODUCED = "reproduced"
DIFFERENT = "reproduced with a difference"
NOT_REPRODUCED = "not reproduced"
NOT_DECIDABLE = "not decidable"
VERDICTS = (REPRODUCED, DIFFERENT, NOT_REPRODUCED, NOT_DECIDABLE)


class Missing(LookupError):
    """A dataset, or something in it, that a claim needs is not there."""


def readable(value) -> str:
    """A number with four digits, or that there is none."""
    return "none" if math.isnan(value) else f"{value:.4g}"


@dataclass(frozen=True)
class Number:
    """One number of the evidence for a claim.

    Attributes
    ----------
    name : str
        Its key in the evidence.
    words : str
        What it is.
    least, most : float
        Where the claim asks for it to be; without either it only informs.
    decisive : bool
        True if the claim falls with it; otherwise the claim holds with a difference.
    """

    name: str
    words: str
    least: float = -math.inf
    most: float = math.inf
    decisive: bool = False

    @property
    def asked(self) -> str:
        """The bounds in words, "" if there are none."""
        if math.isfinite(self.least) and math.isfinite(self.most):
            return f"from {self.least:g} to {self.most:g}"
        bounds = [("at least", self.least), ("at most", self.most)]
        return "".join(f"{word} {bound:g}" for word, bound in bounds if math.isfinite(bound))

    def holds(self, value) -> bool:
        """Whether a value lies within the bounds."""
        return self.least <= value <= self.most


@dataclass(frozen=True)
class Claim:
    """A claim, or a slip taken as the claim that what is printed holds.

    Attributes
    ----------
    number : str
        1 to 19, or S1 to S6 for the slips.
    text : str
        The claim in short words.
    source : str
        Section and figure.
    reading : str
        What we take it to mean where the paper is vague, "" where it is not.
    numbers : tuple of Number
        The evidence, and what the claim asks of it.
    evidence : callable
        From the datasets, by stage and name, to the value of each number, NaN where the
        data do not tell. Raises `Missing`.
    """

    number: str
    text: str
    source: str
    reading: str
    numbers: tuple[Number, ...]
    evidence: Callable[[dict], dict]

    def verdict(self, values) -> str:
        """The verdict on the values of the numbers.

        A decisive number out of its bounds refutes the claim. Otherwise an unknown number
        that has bounds leaves it undecided, and another one out of its bounds is a difference.
        """
        bounded = [number for number in self.numbers if number.asked]
        known = [number for number in bounded if not math.isnan(values[number.name])]
        failed = [number for number in known if not number.holds(values[number.name])]
        if any(number.decisive for number in failed):
            return NOT_REPRODUCED
        if len(known) < len(bounded):
            return NOT_DECIDABLE
        return DIFFERENT if failed else REPRODUCED

    def criterion(self) -> str:
        """What is asked of the numbers: what decides, and what full agreement takes."""
        parts = []
        for lead, decisive in (("Decided by", True), ("In full", False)):
            asked = [
                f"{number.words} {number.asked}"
                for number in self.numbers
                if number.asked and number.decisive == decisive
            ]
            if asked:
                parts.append(f"{lead}: {'; '.join(asked)}.")
        return " ".join(parts)

    def difference(self, values) -> str:
        """A sentence on the numbers that are not what the claim asks for, or unknown."""
        parts = []
        for number in self.numbers:
            value = values[number.name]
            if number.asked and math.isnan(value):
                parts.append(f"{number.words} is unknown")
            elif number.asked and not number.holds(value):
                parts.append(f"{number.words} is {readable(value)} instead of {number.asked}")
        return f"Here {'; '.join(parts)}." if parts else ""

    def judge(self, datasets) -> dict:
        """The claim's row of the table."""
        row = {
            "number": self.number,
            "claim": self.text,
            "source": self.source,
            "reading": self.reading,
            "criterion": self.criterion(),
        }
        try:
            values = self.evidence(datasets)
        except Missing as missing:
            return row | {"evidence": "", "verdict": NOT_DECIDABLE, "difference": f"{missing}."}
        words = {number.name: number.words for number in self.numbers}
        evidence = "; ".join(f"{text}: {readable(values[name])}" for name, text in words.items())
        return row | {
            "evidence": evidence,
            "verdict": self.verdict(values),
            "difference": self.difference(values),
        }
