"""Claims of the paper, numbers that decide them, and verdicts; (7) to (19) are its equations."""
