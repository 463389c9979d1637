"""What there is to say of every key of a mission, made from the tables: explanation, template, docs and JSON Schema."""
