"""Analyses of missions and flights: linear models, studies, tuning."""
