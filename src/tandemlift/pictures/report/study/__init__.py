"""The report of a study: a page of what its rows say together."""
