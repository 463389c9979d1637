"""Errors, and results of checks, whose texts name the place, the value and the allowed range; values as TOML text."""

from __future__ import annotations

import difflib
import json
import math
import re
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any, NamedTuple


class InputError(ValueError):
    """Invalid input: a mission, a setting, a file. The message is complete by itself; the CLI exits with 2."""


class FlightWarning(UserWarning):
    """Warns of a mission that can be flown but is expected to fly badly, with the numbers; `count`: those so far."""

    count = 0

    def __init__(self, *said: object) -> None:
        super().__init__(*said)
        FlightWarning.count += 1


@contextmanager
def without_flight_warnings() -> Iterator[None]:
    """A context in which missions are loaded that nobody needs to be warned of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)
        yield


def nearest(given: str, known: Iterable[str]) -> str | None:
    """The known name that is most similar to the given one, or None."""
    names = {name.lower(): name for name in known}
    close = difflib.get_close_matches(given.lower(), list(names), n=1, cutoff=0.6)
    return names[close[0]] if close else None


def suggestion(given: str, known: Iterable[str]) -> str:
    """' Did you mean …?' for a name close to a known one, else ''."""
    near = nearest(given, known)
    return f" Did you mean {near!r}?" if near else ""


def unknown(what: str, given: object, known: Iterable[str]) -> InputError:
    """The error for a name that is not registered, with the registered names and the closest of them."""
    names, text = list(known), str(given)
    quoted = repr(text if len(text) <= 80 else f"{text[:79]}…")
    return InputError(f"unknown {what} {quoted}; there are {', '.join(names)}.{suggestion(text, names)}")


@contextmanager
def extra(name: str, user: str) -> Iterator[None]:
    """A context in which optional packages are imported.

    Args:
        name: of the extra of tandemlift that has the packages.
        user: the feature that needs them.

    Raises:
        InputError: a package is not installed, with the command that installs it; or it cannot be imported, with what
            it says itself.
    """
    try:
        yield
    except ImportError as error:
        package = (error.name or "").partition(".")[0]
        if isinstance(error, ModuleNotFoundError) and package and find_spec(package) is None:
            raise InputError(f"{user} needs {package}: {install_command(name)}") from None
        said = " ".join(str(error).split())
        raise InputError(
            f"{user}: a package of the extra {name!r} is installed but cannot be imported: {said}"
        ) from error


def install_command(name: str) -> str:
    """The command that installs an extra."""
    return f"pip install 'tandemlift[{name}]'"


OK, CLOSE, FAILS, REFUSED = "ok", "close", "fails", "refused"
SETTINGS = "settings"  # name of the checks whose result is a sentence about keys that do not fit
CLOSE_SHARE = 0.1  # of a limit: less than this share of it left is close


class CheckResult(NamedTuple):
    """A check of a mission.

    Attributes:
        check: its name, as in docs/reference/checks.md.
        subject: the checked part, such as an axis or a key; "" for the whole mission.
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
    check: str, value: float, limit: float, unit: str, text: str, *, subject: str = "", near: float = CLOSE_SHARE
) -> CheckResult:
    """The result of a check whose value must be at most its limit.

    Args:
        check: its name.
        value: the number.
        limit: the largest that is allowed.
        unit: of both.
        text: the sentence, for a value beyond the limit.
        subject: the checked part.
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


def dotted(place: Iterable[str | int]) -> str:
    """The dotted key as `--set` accepts it; a part that is no plain word is quoted."""
    return ".".join(part if re.fullmatch(r"[A-Za-z0-9_-]{1,60}", part) else shown(part) for part in map(str, place))


def shown(value: Any) -> str:
    """A value as one would write it in TOML, on one line of bounded length."""
    text = written(value)
    return text if len(text) <= 70 else f"{text[:69]}…"


def written(value: Any, depth: int = 0) -> str:
    """A value as one would write it in TOML, on one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value[:100], ensure_ascii=not value[:100].isprintable())
    if isinstance(value, int):
        return str(value) if value.bit_length() < 14_000 else f"{value:#x}"[:80]  # Python writes no more digits
    if isinstance(value, (list, tuple)):
        return f"[{_joined(value, depth, lambda item: written(item, depth + 1))}]"
    if isinstance(value, Mapping):
        return f"{{{_joined(value, depth, lambda key: f'{dotted([key])} = {written(value[key], depth + 1)}')}}}"
    return str(value)


def _joined(items: Any, depth: int, write: Callable[[Any], str]) -> str:
    return "…" if depth > 3 else ", ".join(write(item) for item, _ in zip(items, range(40), strict=False))
