"""Engines, where the body of a flight lives; `registry` lists them."""
