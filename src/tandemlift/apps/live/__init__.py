"""The live page: a flight in real time that people watch and push in their browser, or a saved one played again.

`server` serves the page, `session` flies, and `wire` says what goes between them. No request leaves the machine. Needs
the extra `live`.
"""
