"""The live page: a flight in real time that people watch and push in their browser, or a replay of a saved one.

`server` serves the page; `session` flies, and defines the messages of both. No request leaves the machine. Needs the
extra `live`.
"""
