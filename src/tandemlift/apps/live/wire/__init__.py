"""Messages and frames between server and page, each defined once.

`page_messages` come from a page, `server_messages` and the `scene` go to it as JSON, and `frames` as binary data.
`tools/wire_types.py` writes the page's TypeScript types from these definitions, and docs/reference/messages.md has them
as tables.
"""
