"""Requests: to lift, to land, to stop, to tare; done, or the reason why not."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Literal

from tandemlift.common.errors import InputError
from tandemlift.common.faults import ALARM_TEXTS, CHECKS
from tandemlift.common.phases import PHASE_NAMES
from tandemlift.live.session.session import Session
from tandemlift.live.wire.page_messages import AskMessage, TareMessage
from tandemlift.ros.middleware import Answer

COMES_TO = {"lift": "lift", "land": "land", "stop": "stopped"}  # the phase that a request leads to
POSSIBLE = {"lift": ("idle",), "land": ("lift", "guided", "hold", "limited"), "stop": PHASE_NAMES}  # from which
REQUESTS = (*COMES_TO, "tare")
PATIENCE, NAP = 1.0, 0.02  # s, for the pilot to do it, and between looks

What = Literal["lift", "land", "stop"]


class RequestServices:
    """Asks a session's pilot.

    Args:
        session: whose pilot is asked.
        nap: what waits for so long [s].
    """

    def __init__(self, session: Session, nap: Callable[[float], None] = time.sleep) -> None:
        self._session, self._nap = session, nap

    def answer(self, what: str) -> Answer:
        """Ask for one of `REQUESTS`: whether it is done or has begun, and what there is to say of it."""
        try:
            if what == "tare":
                answers = self._session.apply(TareMessage(seq=0))
                return True, next(answer["detail"] for answer in answers if answer["type"] == "done")
            return self._ask(what)
        except InputError as error:
            return False, str(error)

    def _ask(self, what: str) -> Answer:
        phase = self._phase()
        if phase not in POSSIBLE[what]:
            raise InputError(f"{what}: not while the phase is {phase}")
        self._session.apply(AskMessage.model_validate({"seq": 0, "what": what}))
        for _ in range(round(PATIENCE / NAP)):
            if self._phase() == COMES_TO[what]:
                return True, COMES_TO[what]
            self._nap(NAP)
        return False, f"{what}: {self._reason()}"

    def _phase(self) -> str:
        return self._session.status()["phase"]

    def _reason(self) -> str:
        """Why the pilot does not do it."""
        channels = self._session.channels()
        alarm, failed = (int(channels[n][0]) if n in channels else 0 for n in ("alarm", "failed_check"))
        if failed:
            return CHECKS[failed - 1].text
        return ALARM_TEXTS[alarm] if alarm else f"the pilot stays in phase {self._phase()}"
