"""Mutation testing: small mistakes are made in the source, one at a time, and a test has to notice each of them."""
