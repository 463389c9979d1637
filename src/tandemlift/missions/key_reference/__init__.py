"""Documentation of all keys of a mission, made from the tables: explanation, template, docs and JSON Schema."""
