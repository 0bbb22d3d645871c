"""Tables of the paper. CSV files have all columns of a table, Markdown files the first columns."""
