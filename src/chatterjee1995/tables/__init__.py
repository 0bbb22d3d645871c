"""Tables of the paper: a function for each, which returns a frame with heads for people.

The CSV file of a table has all columns, the Markdown file the first nine.
"""
