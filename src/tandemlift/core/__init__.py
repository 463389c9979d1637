"""What every other room may use: the algebra of laws, the tables of missions, the words of the field, errors, files."""
