"""Checks of a mission before its flight, by closed forms: a number, its limit, and the key to change."""
