"""What claims and tables read from datasets."""
