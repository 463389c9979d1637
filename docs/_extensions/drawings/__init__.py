"""Drawings of the explanation, for the directive `generated`: in the colours of the page, light or dark."""
