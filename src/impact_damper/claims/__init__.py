"""Claims of the paper, each with the numbers that decide it and a verdict from the datasets."""
