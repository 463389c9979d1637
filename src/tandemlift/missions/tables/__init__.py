"""The whole of a mission: the tables of its parts, and what a flight is judged by.

Every table is strict: unknown keys, wrong types and non-finite numbers are refused. A leaf that is given per axis
takes one number for all axes or one number each. The built-in missions in `data/missions` hold the numbers.
"""
