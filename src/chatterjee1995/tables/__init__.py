"""Tables of the paper. A CSV file has all columns; a Markdown file has the first `files.SHOWN`."""
