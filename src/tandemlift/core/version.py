"""The version of the package, here so that rooms can say it without what the package offers outside."""

__version__ = "0.2.0"
