"""Claims of the paper, their deciding numbers and verdicts; (7) to (19) are its equations."""
