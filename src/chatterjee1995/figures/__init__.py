"""Functions that draw figures, one for each kind of figure. All numbers come from datasets."""
