"""C as text: names, numbers, structs, statements and functions, made from traced laws."""
