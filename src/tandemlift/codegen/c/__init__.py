"""C from traced laws: types, expressions, statements, functions and files."""
