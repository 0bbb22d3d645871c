"""Claims of the paper, their evidence and verdicts; (7) to (19) are equations of the paper."""
