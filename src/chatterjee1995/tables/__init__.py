"""Tables of the paper. A CSV file has all columns of a table, a Markdown file the first nine."""
