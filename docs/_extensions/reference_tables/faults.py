"""The tables of phases, of reasons not to follow, of checks before a lift, and of faults with their reactions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from reference_tables.markdown import codes, table
from tandemlift.core.faults import CHECKS, FAULTS, REACTION_MEANINGS
from tandemlift.core.phases import PHASES, REASONS


class FaultRow(NamedTuple):
    """A fault in one of its forms: its number, its text, its detection, its key and its default reaction."""

    number: int
    text: str
    detection: str
    key: str
    reaction: str


def fault_rows() -> Iterator[FaultRow]:
    """Every fault, by priority; one of a sensor in each of its forms."""
    for fault in FAULTS:
        forms = [(f"{fault.text} {s.text}", s.detection.format(range=fault.detection)) for s in fault.symptoms]
        for text, detection in forms or [(fault.text, fault.detection)]:
            yield FaultRow(fault.number, text, detection, fault.key, fault.reaction)


def faults() -> str:
    """Every fault with its default reaction."""
    rows = [(str(row.number), row.text, row.detection, f"`{row.key}`", row.reaction) for row in fault_rows()]
    return table(("number", "fault", "detected when", "key in `supervision.reactions`", "default"), rows)


def reactions() -> str:
    """Every reaction, from the weakest to the strongest."""
    return table(("reaction", "the vehicle"), [(f"`{name}`", text) for name, text in REACTION_MEANINGS.items()])


def lift_checks() -> str:
    """The checks before a lift, and before pushes are followed."""
    rows = [(str(check.number), check.passes, check.before, codes(check.keys)) for check in CHECKS]
    return table(("number", "condition", "before", "keys"), rows)


def phases() -> str:
    """The phases of interactive guidance."""
    rows = [(f"`{p.name}`", str(i), p.rotors, p.pushes, p.reference) for i, p in enumerate(PHASES)]
    return table(("phase", "number", "rotors", "pushes", "reference"), rows)


def reasons() -> str:
    """The reasons why a vehicle cannot follow its reference."""
    rows = [(reason.text, str(i), reason.detection) for i, reason in enumerate(REASONS, start=1)]
    return table(("reason", "number", "present when"), rows)
