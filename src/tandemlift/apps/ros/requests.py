"""Requests: to lift, to land, to stop, to tare; done, or the reason why not and what to do."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Literal

from tandemlift.apps.live.session.session import Session
from tandemlift.apps.live.wire.page_messages import AskMessage, TareMessage
from tandemlift.apps.ros.diagnostics import Notify
from tandemlift.apps.ros.middleware import Answer
from tandemlift.core.errors import InputError
from tandemlift.core.phases import PHASE_NAMES

COMES_TO = {"lift": "lift", "land": "land", "stop": "stopped"}  # the phase that a request leads to
POSSIBLE = {  # from which
    "lift": ("idle",),
    "land": ("lift", "guided", "hold", "contact", "limited"),
    "stop": PHASE_NAMES,
}
REQUESTS = {
    "lift": "takes off from the ground",
    "land": "lands",
    "stop": "stops all rotors at once, until the node is restarted",
    "tare": "tares the force sensors: their mean over `estimator.tare_duration`, from a second later on, becomes their "
    "bias; in the air, with nobody pushing; only for a mission with `estimator.tare_start` whose pilot reads sensors",
}
PATIENCE, NAP = 1.0, 0.02  # s, for the pilot to do it, and between looks

What = Literal["lift", "land", "stop"]


class RequestServices:
    """Asks a session's pilot.

    Args:
        session: whose pilot is asked.
        notify: called with what is refused.
        nap: what waits for so long [s].
    """

    def __init__(self, session: Session, notify: Notify, nap: Callable[[float], None] = time.sleep) -> None:
        self._session, self._notify, self._nap = session, notify, nap

    def answer(self, what: str) -> Answer:
        """Ask for one of `REQUESTS`: whether it is done or has begun, and what there is to say of it."""
        try:
            if what == "tare":
                answers = self._session.apply(TareMessage(seq=0))
                return True, next(answer["detail"] for answer in answers if answer["type"] == "done")
            return self._ask(what)
        except InputError as error:
            self._notify(str(error))
            return False, str(error)

    def _ask(self, what: str) -> Answer:
        if self._phase() in POSSIBLE[what]:
            self._session.apply(AskMessage.model_validate({"seq": 0, "what": what}))
            for _ in range(round(PATIENCE / NAP)):
                if self._phase() == COMES_TO[what]:
                    return True, COMES_TO[what]
                self._nap(NAP)
        raise InputError(self._refusal(what))

    def _phase(self) -> str:
        return self._session.status()["phase"]

    def _refusal(self, what: str) -> str:
        """Why the pilot does not do it, and what to do."""
        refusal = getattr(self._session.refusals, what, None)
        return str(refusal) if refusal else f"{what}: the pilot stays in phase {self._phase()}; ask again"
