"""Figures, pictures and films of flights, and reports."""
