"""The report of a study: a page on all its rows."""
