"""Claims of the paper, numbers that decide them, and verdicts. (7) is equation (7) of the paper."""
