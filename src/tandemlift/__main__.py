"""`python -m tandemlift`."""

from tandemlift.cli import main

main()
