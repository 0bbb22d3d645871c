"""The claims of the paper, the numbers that test each claim, and the verdicts on them."""
