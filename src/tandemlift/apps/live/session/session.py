"""One flight in real time, in a thread of its own, pushed by whoever holds the beam.

Every method may be called from any thread. Scene and status are available before the flight is compiled. The
flight never waits: a change that takes long is prepared in another thread.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from functools import partial, singledispatchmethod
from pathlib import Path
from typing import Any

from tandemlift.apps.live.session import page_messages as page
from tandemlift.apps.live.session import server_messages as server
from tandemlift.apps.live.session.checks import NO_REQUESTS, check_may_tare, check_repeatable
from tandemlift.apps.live.session.hand_control import HandControl, hands_off
from tandemlift.apps.live.session.interactive_mission import interactive_mission, other_mission, with_whole_rotors
from tandemlift.apps.live.session.pacing import Pacer, RealTimeThread
from tandemlift.apps.live.session.parameters import CHOICES, ParameterControl, scene_at
from tandemlift.apps.live.session.saving import save_in_process
from tandemlift.apps.live.session.scene_builder import FrameBuilder
from tandemlift.apps.live.session.status import FlightFindings, Preparation, phase_of, refusals_now, status_of
from tandemlift.core.errors import InputError
from tandemlift.core.refusals import Refusals
from tandemlift.core.types import Array
from tandemlift.core.vector import Quat
from tandemlift.missions import Mission, tables_of
from tandemlift.simulation.recorded_flight import FlightSetup, RecordedFlight, setup_flight
from tandemlift.simulation.results import channels_of

log = logging.getLogger(__name__)
Inputs = Callable[[RecordedFlight], Array]


class Session:
    """Flies a mission in real time. There is a scene, a frame and a status also while the flight is being prepared.

    Args:
        mission: the flown one, without its pushes and its person.
        engine: name of the body's engine.
        out: folder of saved flights, each in a folder of its name.
        inputs: before each step, the numbers of a `CallerInput`; such a flight cannot be flown again or saved.

    Attributes:
        generation: grows with every reset, after which `scene` is a new one.
        is_ready: whether the flight is compiled; until then the vehicle is shown at its start.
        watchers: called after every step, in the flight's thread.
        pacer: the pace of the flight.
        turn: lock of who changes the flight.

    Raises:
        InputError: the mission cannot be flown interactively, or cannot be built.
    """

    def __init__(
        self, mission: Mission, engine: str = "compiled", out: Path = Path("out/live"), inputs: Inputs | None = None
    ) -> None:
        self._mission, self._engine, self._out = interactive_mission(mission), engine, out
        self._inputs, self._setup = inputs, partial(setup_flight, engine=engine, interactive=inputs is not None)
        self._lock, self.pacer = threading.RLock(), Pacer(mission.mission.step)
        self._thread = RealTimeThread(self.pacer, self._lock, self._is_prepared, self._fly)
        self._parameters = ParameterControl(tables_of(self._mission), self._lock)
        self.turn = self._parameters.turn
        self._failed, self._findings = False, FlightFindings()
        self.generation, self.watchers = 1, list[Callable[[RecordedFlight], None]]()
        self._flight: RecordedFlight
        self._hand: HandControl
        self._preparation, self.is_ready = Preparation(), False
        self._first = self._setup(self._mission)
        self._frames = FrameBuilder(self._first.plan)

    def prepare(self) -> None:
        """Compile the flight, and take its first step; once."""
        if not self.is_ready:
            self._preparation.step = "compiling the flight loop"
            self._begin(self._first)
            self.is_ready = True

    def _begin(self, setup: FlightSetup, other: Mission | None = None) -> None:
        """Begin a flight; `other`: the mission that its parameters are restored to, if that is another one."""
        flight, frames = RecordedFlight(setup.plan.mission, self._engine, setup), FrameBuilder(setup.plan)
        flight.hold()
        flight.advance()
        with self._lock:
            if other is not None:
                self._mission, self._parameters.first, self.pacer.dt = other, tables_of(other), flight.dt
            self._frames = frames
            self._continue(flight)

    def _continue(self, flight: RecordedFlight) -> None:
        """Let a flight be the one in progress; to be called with the lock."""
        self._flight, self._failed = flight, False
        self._hand = HandControl(flight, self._frames.scene["vehicle"])

    @property
    def flight(self) -> RecordedFlight:
        """The flight in progress, once it is ready; a reset begins another."""
        return self._flight

    def start(self) -> None:
        """Prepare the flight, and fly, in a thread of its own."""
        self._thread.start()

    def stop(self) -> None:
        """End the flight's thread, without waiting for the compiler."""
        self._thread.stop(wait=self.is_ready)

    def _is_prepared(self) -> bool:
        """Prepare the flight, and begin to optimise its code; whether that worked."""
        try:
            self.prepare()
            self._flight.optimise()
        except Exception as error:
            told = isinstance(error, InputError | OSError)  # the latter of an engine that is lost, or a file
            log.error("error: the flight cannot be flown: %s", error, exc_info=not told)
            self._preparation.failure = str(error) if told else repr(error)
            return False
        return True

    def _fly(self, steps: int) -> int:
        """Fly some steps, at most to the end of the flight; return their number."""
        before = self._flight.step
        try:
            while self._flight.step < before + steps and not self._flight.over and not self._failed:
                self._hand.expire_requests()
                self._flight.advance(self._inputs and self._inputs(self._flight))
                if self._flight.interruption:
                    break
                for watch in self.watchers:
                    watch(self._flight)
            if steps == 0:
                self._flight.rest()
        except Exception:
            self._failed = True  # until a reset
            log.exception("the flight ended by an error")
        return self._flight.step - before

    @property
    def scene(self) -> server.FlightScene:
        """The scene with the present parameters."""
        return scene_at(self._frames.scene, self._flight.now if self.is_ready else self._mission, self._mission)

    def frame(self) -> bytes:
        """The latest frame."""
        if not self.is_ready:
            return self._frames.first()
        with self._lock:
            moment, hand, seq, frames = self._flight.moment, self._flight.hand, self._hand.seq, self._frames
        points = {"hand_point": hand.grip, "hand_target": hand.target, "push_point": hand.grip}
        return frames.frame({**frames.values(*moment), **points, "held": hand.held, "seq": seq % 2**24})

    def past(self) -> list[bytes]:
        """The frames of the last seconds, oldest first, for the plots of a page that joins; without hand and ghost."""
        with self._lock:
            return self._frames.past(*self._flight.logged()) if self.is_ready else []

    def channels(self) -> dict[str, Any]:
        """The channels of the latest sample (1, …)."""
        return dict(channels_of(self._flight.layout, self._flight.sample[None, :].copy()))

    def status(self) -> server.FlightStatus:
        """The state of the flight in words, and its pace; before it flies, the progress of its preparation."""
        if not self.is_ready:
            return self._preparation.status()
        with self._lock:
            status = status_of(self._flight, self.pacer, self._values(), self._frames.scene["vehicle"], self._failed)
            self._findings.look(self._flight)
        return self._findings.added_to(status)

    @property
    def refusals(self) -> Refusals:
        """The refusals that would apply now, with reasons and remedies."""
        with self._lock:
            return refusals_now(self._flight, self._failed)

    def _values(self) -> dict[str, Any]:
        return self._frames.values(*self._flight.moment)

    def apply(self, message: page.PageMessage) -> list[server.Answer]:
        """Apply a message; return the answers.

        Raises:
            InputError: it cannot be done; the text says why.
        """
        if not self.is_ready:
            raise InputError(self._preparation.refusal)
        if self._inputs and isinstance(message, page.RewindMessage | page.SaveMessage | page.FlyMessage):
            raise InputError(f"{message.type}: not while clients fly the quadrotors")
        if isinstance(message, page.BeamMessage):
            with self._lock:
                self._hand.seq = message.seq
        return self._handle(message) or []

    def release(self) -> None:
        """Release the beam."""
        if self.is_ready:
            with self._lock:
                self._hand.release()

    def _check_takes_requests(self, what: str) -> None:
        if self._mission.pilot.guidance == "scheduled":
            raise InputError(NO_REQUESTS.format(what=what, mission=self._mission.mission.name))

    @singledispatchmethod
    def _handle(self, message: Any) -> list[server.Answer] | None:
        raise InputError(f"{message.type}: cannot be handled here")

    @_handle.register
    def _move_hand(self, m: page.BeamMessage) -> None:
        with self._lock:
            self._hand.take(m, lambda: Quat(*self._values()["attitude"]))

    @_handle.register
    def _ask(self, m: page.AskMessage) -> list[server.Answer]:
        self._check_takes_requests(m.what)
        with self._lock:
            self._hand.request(m)
        refusal = None if m.what == "stop" else getattr(self.refusals, m.what)
        return [server.RefusedMessage(type="refused", what=m.type, reason=str(refusal))] if refusal else []

    @_handle.register
    def _enable(self, m: page.EnableMessage) -> None:
        self._check_takes_requests("enable")
        with self._lock:
            self._hand.enable(m.on)

    @_handle.register
    def _pause(self, m: page.PauseMessage) -> None:
        with self._lock:  # so that no step is taken after it
            self.pacer.paused = m.on

    @_handle.register
    def _set_speed(self, m: page.SpeedMessage) -> None:
        self.pacer.speed = m.factor

    @_handle.register
    def _reset(self, m: page.ResetMessage) -> None:
        with self.turn:
            self._begin(self._setup(with_whole_rotors(self._flight.now, self._mission)))
            self.generation += 1

    @_handle.register
    def _rewind(self, m: page.RewindMessage) -> None:
        check_repeatable(self._engine)
        with self.turn:
            past, self.pacer.paused = self._flight, True
            again = self._flown_again(past, round(m.time / past.dt) + 1)
            hands_off(again)
            with self._lock:
                self._continue(again)
            self.generation += 1

    def _flown_again(self, past: RecordedFlight, steps: int) -> RecordedFlight:
        """A flight with the same start, hand and changes as a past one, for so many of its steps at most."""
        again = RecordedFlight(past.start, self._engine)
        again.repeat(past, min(steps, past.step))
        return again

    @_handle.register
    def _fly_another(self, m: page.FlyMessage) -> list[server.Answer]:
        with self.turn:
            mission = other_mission(m)
            self._begin(self._setup(mission), mission)
            self.generation += 1
        self._flight.optimise()
        return [server.DoneMessage(type="done", what="fly", detail=m.mission)]

    @_handle.register
    def _save(self, m: page.SaveMessage) -> list[server.Answer]:
        with self._lock:
            snapshot = self._flight.snapshot()
        save_in_process(snapshot, folder := self._out / m.name)
        return [server.DoneMessage(type="done", what="save", detail=str(folder))]

    @_handle.register
    def _tare(self, m: page.TareMessage) -> list[server.Answer]:
        with self._lock:
            phase = phase_of(self._flight, int(self._values()["phase"][0]), self._failed)
            check_may_tare(self._flight, self._frames.scene["vehicle"], phase)
        return [server.DoneMessage(type="done", what="tare", detail=self._parameters.tare(self._flight))]

    @_handle.register
    def _stop_rotor(self, m: page.KillMessage) -> None:
        self._parameters.stop_rotor(self._flight, m.rotor)

    @_handle.register
    def _set(self, m: page.SetMessage) -> list[server.Answer]:
        return self._with_scene(self._parameters.set(self._flight, m.key, m.value))

    @_handle.register
    def _restore(self, m: page.RestoreMessage) -> list[server.Answer]:
        return self._with_scene(self._parameters.restore(self._flight, m.key))

    def _with_scene(self, answers: list[server.Answer]) -> list[server.Answer]:
        """Answers, and after a choice the scene, as there may be other parameters now."""
        chosen = any(one["type"] == "changed" and one["key"] in CHOICES for one in answers)
        return [*answers, server.SceneMessage(type="scene", **self.scene)] if chosen else answers
