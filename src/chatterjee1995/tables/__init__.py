"""Tables of the paper. A CSV file has all columns, a Markdown file the first `SHOWN` columns."""
