"""The tables of channels in docs/reference/channels.md, made from `flight.channels`."""

from __future__ import annotations

import textwrap

from tandemlift.flight.channels import GROUPS, Channel, ChannelGroup

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
