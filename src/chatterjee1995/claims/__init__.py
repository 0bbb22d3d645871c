"""Claims of the paper, numbers that decide the claims, and verdicts on the claims."""
