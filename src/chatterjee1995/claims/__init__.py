"""The claims of the paper, the evidence on each claim (numbers), and the verdicts."""
