"""Chunks of work of a study: some hundreds of flights, one file of results, flown here or on other machines."""
