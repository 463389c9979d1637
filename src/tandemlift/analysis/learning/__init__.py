"""Environments of Gymnasium: tasks of this field over flights that step together."""
