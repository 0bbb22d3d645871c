"""Claims of the paper, each with the numbers (measures) that decide it and its verdict."""
