"""The tables of channels."""

from __future__ import annotations

from reference_tables.markdown import table
from tandemlift.flight.channels import GROUPS, Channel, ChannelGroup

PER = {"": "{}", "rotor": "{} per rotor", "quadrotor": "{} per quadrotor"}


def channel_tables() -> str:
    """A table for each group of channels."""
    return "\n".join(map(_section, GROUPS))


def _section(group: ChannelGroup) -> str:
    rows = [_row(name, channel) for name, channel in group.channels.items()]
    note = f"{group.note.strip()}\n\n" if group.note else ""
    return f"### {group.when}\n\n{note}{table(('channel', 'columns', 'unit', 'frame', 'meaning'), rows)}"


def _row(name: str, channel: Channel) -> tuple[str, ...]:
    return (f"`{name}`", PER[channel.per].format(channel.width), channel.unit, channel.frame, channel.meaning)
