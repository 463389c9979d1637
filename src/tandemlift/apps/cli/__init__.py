"""The command line, with its entry point in `main`."""
