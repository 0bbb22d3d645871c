"""Functions that read from datasets what the claims and tables need."""
