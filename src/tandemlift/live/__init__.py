"""A flight that people watch, and push, in a page of their browser: live or again.

`messages` is what a page may say, `scene` and `frames` what it is told, `server` between them. No request leaves the
machine. Needs the extra `live`.
"""
