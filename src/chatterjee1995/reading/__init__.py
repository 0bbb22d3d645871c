"""Numbers that claims and tables read from datasets."""
