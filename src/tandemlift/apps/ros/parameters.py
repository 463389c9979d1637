"""Parameters of a mission that are changed while it flies, by their keys in the mission.

`admittance.mass`, `admittance.stiffness` and `admittance.damping_ratio` are called as ros2_controllers' admittance
controller calls them, and mean the same; the ratio is D/(2 √(M K)) of each axis with stiffness, and 0 of one without.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from tandemlift.apps.live.session.page_messages import SetMessage
from tandemlift.apps.live.session.parameters import parameters_of
from tandemlift.apps.live.session.server_messages import SceneParameter
from tandemlift.apps.live.session.session import Session
from tandemlift.apps.ros.diagnostics import Notify
from tandemlift.apps.ros.middleware import Middleware, ParameterFacts
from tandemlift.core.errors import InputError, shown, unknown
from tandemlift.core.keys import Triple
from tandemlift.missions import tables_of

DAMPING, RATIO = "admittance.damping", "admittance.damping_ratio"
SPRING = ("person.stiffness", "person.damping")  # of a page's hand; here pushes are forces
DEPENDENT_KEYS = (DAMPING, RATIO)  # are set after mass and stiffness, of which they are formed


class Parameters:
    """The parameters of a session.

    Args:
        session: whose settings they are.
        middleware: where they are kept.
        notify: called with refusals.
    """

    def __init__(self, session: Session, middleware: Middleware, notify: Notify) -> None:
        self._session, self._middleware, self._notify = session, middleware, notify
        self._first, self._known = tables_of(session.flight.now), session.flight.now
        self._turn = threading.RLock()  # what is kept is never older than a change
        facts = {parameter["key"]: _facts(parameter) for parameter in self._all()}
        ratio = ParameterFacts("damping ratio D/(2 √(M K)) of each axis with stiffness, else 0")
        middleware.declare(facts | {RATIO: ratio}, self.change)

    def exchange(self) -> bool:
        """Apply what has been set, and set all to the present values; whether anything changed since the last time."""
        wishes, before = self._middleware.parameters(), self._known
        for key in sorted(wishes, key=lambda key: (key in DEPENDENT_KEYS, key)):
            self.change(key, wishes[key])
        with self._turn:
            self._middleware.keep(dict(self._values()))
        self._known = self._session.flight.now
        return self._known is not before

    def _all(self) -> Iterator[SceneParameter]:
        found = parameters_of(tables_of(self._session.flight.now), self._first)
        return (parameter for parameter in found if parameter["key"] not in SPRING)

    def _values(self) -> Iterator[tuple[str, Any]]:
        for parameter in self._all():
            yield parameter["key"], parameter["value"]
        a = self._session.flight.now.admittance
        yield RATIO, damping_ratio(a.mass, a.damping, a.stiffness)

    def change(self, key: str, value: object) -> str:
        """Set a parameter; return the reason if it is refused, else an empty text."""
        known = dict(self._values())
        try:
            if key not in known:
                raise unknown("parameter", key, known)
            if key == RATIO:
                a = self._session.flight.now.admittance
                key, value = DAMPING, damping_of(value, a.mass, a.damping, a.stiffness)
            with self._turn:
                self._session.apply(_message(key, value))
        except InputError as error:
            self._notify(f"parameter refused: {error}")
            return str(error)
        return ""


def _facts(parameter: SceneParameter) -> ParameterFacts:
    if choices := parameter.get("choices"):
        return ParameterFacts(f"{parameter['label']}: one of {', '.join(choices)}")
    return ParameterFacts(f"{parameter['label']} [{parameter['unit']}]", parameter["min"], parameter["max"])


def _message(key: str, value: Any) -> SetMessage:
    """The message to a session that sets a key.

    Raises:
        InputError: the value is of no kind that a setting has.
    """
    try:
        return SetMessage(seq=0, key=key, value=tuple(value) if isinstance(value, list) else value)
    except ValidationError:
        raise InputError(f"{key} = {shown(value)}: must be a number, a list of numbers, or a word") from None


def damping_ratio(mass: Triple, damping: Triple, stiffness: Triple) -> list[float]:
    """D/(2 √(M K)) of each axis of the admittance; 0 where there is no stiffness."""
    axes = zip(mass, damping, stiffness, strict=True)
    return [d / (2.0 * math.sqrt(m * k)) if k > 0.0 else 0.0 for m, d, k in axes]


def damping_of(ratio: object, mass: Triple, damping: Triple, stiffness: Triple) -> list[float]:
    """The damping [N s/m] of each axis that has a damping ratio; an axis without stiffness keeps its own.

    Raises:
        InputError: these are no three numbers, or one is of an axis without stiffness.
    """
    numbers = ratio if isinstance(ratio, list) else [ratio] * 3
    if len(numbers) != 3 or not all(isinstance(x, (int, float)) and math.isfinite(x) for x in numbers):
        raise InputError(f"{RATIO} = {shown(ratio)}: must be a number, or three")
    found = list[float]()
    for x, m, d, k in zip(numbers, mass, damping, stiffness, strict=True):
        if k == 0.0 and x != 0.0:
            raise InputError(f"{RATIO} = {shown(ratio)}: must be 0 on an axis without stiffness; set {DAMPING} there")
        found.append(2.0 * x * math.sqrt(m * k) if k > 0.0 else d)
    return found
