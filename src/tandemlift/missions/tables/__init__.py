"""The tables of a whole mission: those of its parts, and the criteria for outcomes and findings.

Every table is strict: unknown keys, wrong types and non-finite numbers are refused. A key that is given per axis
takes one number for all axes or one number each. The built-in missions in `data/missions` hold the numbers.
"""
