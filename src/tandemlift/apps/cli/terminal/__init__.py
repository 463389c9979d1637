"""What all verbs of the command line share: output, notices, the folder of results."""
