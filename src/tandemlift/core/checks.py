"""The result of a check of a mission: a number against its limit, or a sentence, and the verdict.

Each part yields the results that are about it, beside its table. `missions.checks` puts them in one list.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from tandemlift.core.errors import InputError

OK, CLOSE, FAILS, REFUSED = "ok", "close", "fails", "refused"
SETTINGS = "settings"  # name of the checks whose result is a sentence about keys that do not fit
NEAR = 0.1  # of a limit: less than this share of it left is close


class CheckResult(NamedTuple):
    """A check of a mission.

    Attributes:
        check: its name, as in docs/reference/checks.md.
        subject: what was checked, such as an axis or a key; "" for the whole mission.
        value: the number; None where there is only a sentence.
        limit: the largest that is allowed; None likewise.
        unit: of both.
        verdict: "ok", "close", "fails" or "refused". Loading a mission warns of each check that fails, and raises for
            one that is refused.
        text: the number, the limit and the key to change, in one sentence; "" if the check passes.
    """

    check: str
    subject: str
    value: float | None
    limit: float | None
    unit: str
    verdict: str
    text: str

    @property
    def margin(self) -> float | None:
        """The share of the limit that is left; below 0 where the check fails."""
        if self.value is None or self.limit is None or self.limit <= 0.0 or math.isinf(self.limit):
            return None
        return 1.0 - self.value / self.limit


def judged(
    check: str, value: float, limit: float, unit: str, text: str, *, subject: str = "", near: float = NEAR
) -> CheckResult:
    """The result of a check whose value must be at most its limit.

    Args:
        check: its name.
        value: the number.
        limit: the largest that is allowed.
        unit: of both.
        text: the sentence, for a value beyond the limit.
        subject: what was checked.
        near: the share of the limit below which a margin is close.
    """
    if math.isnan(value) or math.isnan(limit):
        return noted(check, "its numbers are too extreme to compute with", verdict=CLOSE, subject=subject)
    verdict = FAILS if value > limit else CLOSE if value > limit - near * abs(limit) else OK
    return CheckResult(check, subject, float(value), float(limit), unit, verdict, text if verdict == FAILS else "")


def noted(check: str, text: str, *, verdict: str, subject: str = "") -> CheckResult:
    """A result with a sentence and no numbers."""
    return CheckResult(check, subject, None, None, "", verdict, text)


def refused(text: str) -> CheckResult:
    """The result for keys with which a mission cannot be flown: the key, its value and the allowed range."""
    return noted(SETTINGS, text, verdict=REFUSED)


def warned(text: str) -> CheckResult:
    """The result for keys with which a mission is expected to fly badly, with the numbers."""
    return noted(SETTINGS, text, verdict=FAILS)


def accepted(results: Iterable[CheckResult]) -> list[CheckResult]:
    """The results as a list, if none of them is refused.

    Raises:
        InputError: with the sentence of the first that is; nothing after it is computed.
    """
    taken = []
    for result in results:
        if result.verdict == REFUSED:
            raise InputError(result.text)
        taken.append(result)
    return taken
