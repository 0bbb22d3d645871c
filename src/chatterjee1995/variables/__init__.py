"""Variables of datasets that only the paper has, a module for each subject."""
