"""Shared by all other rooms: the algebra of laws, tables of missions, the field's vocabulary, errors and files."""
