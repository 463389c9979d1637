"""A mission as the text of a file that gives the same mission."""

from tandemlift.missions import format_toml, tables_of


def to_toml(mission):
    """The mission as TOML with all its keys."""
    return format_toml(tables_of(mission))
