"""The findings of a flight as a part of its report: under the verdict, in words, with remedies."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape

from tandemlift.core.findings import Finding
from tandemlift.flight.record import Flight


def html_findings(flight: Flight) -> str:
    """The findings as a list; a sentence if there are none, nothing for a flight that was never searched for any."""
    if not flight.findings:
        return '\n<p class="soft">No findings.</p>' if "findings" in flight.results else ""
    items = "\n".join(f"<li>{_item(finding)}</li>" for finding in flight.findings)
    return f'\n<h3>Findings</h3>\n<ul class="findings">\n{items}\n</ul>'


def _item(finding: Finding) -> str:
    where = "" if finding.place is None else f", at {html_place(finding.place)}"
    what = f"<strong>{escape(finding.kind)}</strong> at {finding.time:.2f} s{where}: {escape(finding.text)}."
    return f'{what}<br><span class="soft">What to do: {with_keys(finding.remedy)}.</span>'


def html_place(point: Iterable[float]) -> str:
    """A point of space in metres, to the millimetre."""
    return f"({', '.join(f'{round(v, 3) + 0.0:.3f}'.replace('-', '−') for v in point)}) m"


def with_keys(text: str) -> str:
    """A text as HTML whose `keys` are set as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))
