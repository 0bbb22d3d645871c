"""One function for each kind of figure. It only draws: all numbers come from datasets."""
