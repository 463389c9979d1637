"""One flight in real time and what page and server say about it, each message and frame defined once.

`session` flies it, with the virtual hand, changes in flight and the recording. `page_messages` come from a page,
`server_messages` go to it as JSON, and `frames` as binary data. `tools/wire_types.py` writes the page's TypeScript
types from these definitions, and docs/reference/messages.md has them as tables.
"""
