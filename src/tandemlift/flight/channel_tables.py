"""The tables of channels in docs/flights.md, made from `flight.channels`.

    python -m tandemlift.flight.channel_tables docs/flights.md

rewrites them; a test compares.
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

from tandemlift.flight.channels import GROUPS, Channel, ChannelGroup

BEGIN = "<!-- made by: python -m tandemlift.flight.channel_tables docs/flights.md -->"
END = "<!-- end of what is made -->"
HEAD = "| name | columns | unit | frame | meaning |\n|---|---|---|---|---|"
PER = {"": "{}", "rotor": "{} per rotor", "quadrotor": "{} per quadrotor"}


def channel_tables() -> str:
    """All groups of channels in Markdown, a table each."""
    return "\n\n".join(map(_table, GROUPS))


def _table(group: ChannelGroup) -> str:
    rows = "\n".join(_row(name, channel) for name, channel in group.channels.items())
    heading = textwrap.fill(f"{group.when}{'. ' if group.note else ':'}{group.note}", 120)
    return f"{heading}\n\n{HEAD}\n{rows}"


def _row(name: str, channel: Channel) -> str:
    columns = PER[channel.per].format(channel.width)
    return f"| `{name}` | {columns} | {channel.unit} | {channel.frame} | {channel.meaning} |"


def with_tables(page: str) -> str:
    """A page with the tables as they are now between `BEGIN` and `END`."""
    return re.sub(f"(?s){re.escape(BEGIN)}.*{re.escape(END)}", f"{BEGIN}\n\n{channel_tables()}\n\n{END}", page)


if __name__ == "__main__":
    for path in map(Path, sys.argv[1:]):
        path.write_text(with_tables(path.read_text("utf-8")), "utf-8")
