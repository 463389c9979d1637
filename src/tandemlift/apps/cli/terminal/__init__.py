"""Common parts of all verbs of the command line: output, notices, the folder of results."""
