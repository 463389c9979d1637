"""One flight in real time, in a thread of its own, moved by the hand of whoever holds the beam.

Every method may be called from any thread. There is something to see before the flight is compiled. The flight never
waits for anybody: a change that takes long to make ready is made ready beside it.
"""

from __future__ import annotations

import logging
import sys
import threading
import time
from collections.abc import Callable
from functools import singledispatchmethod
from pathlib import Path
from typing import Any

from tandemlift.algebra.vector import ZERO, Quat, Vec3, apply
from tandemlift.common.errors import InputError
from tandemlift.flight.channels import PHASES
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion
from tandemlift.laws.person.virtual_hand import NOBODY_HOLDS
from tandemlift.live import messages
from tandemlift.live.by_hand import by_hand, renewed
from tandemlift.live.controls import CHOICES, controls_of
from tandemlift.live.framing import Framing
from tandemlift.live.grip import Grip
from tandemlift.live.knobs import Knobs
from tandemlift.live.pace import BATCH, BREATH, NAP, SWITCHING, Pace
from tandemlift.live.preparing import Preparing, without_long_pauses
from tandemlift.live.recorded import Ready, RecordedFlight, ready_of
from tandemlift.live.saving import save_aside
from tandemlift.live.scene import alarm_names
from tandemlift.live.states import check_listens, check_touch, dead_rotors
from tandemlift.live.taring import check_may_tare
from tandemlift.settings import Mission
from tandemlift.simulation.results import channels_of

WISH = 0.2  # s, for which a wish to lift or to land is said

log = logging.getLogger(__name__)


class Session:
    """See the module; `server.LiveFlight` says what a server needs of it.

    Args:
        mission: flown by hand: its pushes and its person are left out.
        engine: name of the body's engine.
        out: folder that flights are saved in, each in one of its name.

    Attributes:
        is_ready: whether it flies, or may; until then a viewer sees where the vehicle stands.
        watchers: told of every step, in the flight's thread.
        pace: how the flight keeps up with the clock.

    Raises:
        InputError: the mission cannot be flown by hand, or cannot be built.
    """

    def __init__(self, mission: Mission, engine: str = "compiled", out: Path = Path("out/live")) -> None:
        self._mission, self._engine, self._out = by_hand(mission), engine, out
        self._lock, self._stopping = threading.RLock(), threading.Event()
        self._thread = threading.Thread(target=self._run, name="flight", daemon=True)
        self._knobs, self._names, self._failed = Knobs(self._mission, self._lock), alarm_names(), False
        self.pace = Pace(mission.mission.step)
        self.generation, self.watchers = 1, list[Callable[[RecordedFlight], None]]()
        self._flight: RecordedFlight
        self._preparing, self.is_ready = Preparing(), False
        self._first = ready_of(self._mission, engine)
        self._framing = Framing(self._mission, engine, self._first)

    def prepare(self) -> None:
        """Compile what the flight needs, and take its first step; once."""
        if not self.is_ready:
            self._preparing.step = "compiling the flight loop"
            self._begin(self._mission, self._first, self._framing)
            self.is_ready = True

    def _begin(self, mission: Mission, ready: Ready, framing: Framing) -> None:
        flight = RecordedFlight(mission, self._engine, ready)
        flight.hold(NOBODY_HOLDS)
        flight.advance()
        with self._lock:
            self._flight, self._framing = flight, framing
            self._grip, self._failed = Grip(), False

    @property
    def flight(self) -> RecordedFlight:
        """What is flown, until a reset; once it is ready."""
        return self._flight

    @property
    def scene(self) -> dict[str, Any]:
        """What a viewer must know, with the settings as they are."""
        now = self._flight.now if self.is_ready else self._mission
        p = now.person
        spring = {"stiffness": p.stiffness, "damping": p.damping, "max_force": p.max_force}
        about = {"threshold": list(now.admittance.threshold), "spring": spring}
        return self._framing.scene | about | {"controls": list(controls_of(now, self._mission))}

    # the thread

    def start(self) -> None:
        """Prepare the flight, and fly, in a thread of its own."""
        self._thread.start()

    def stop(self) -> None:
        """End the flight's thread; nobody waits for one that still compiles."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join(None if self.is_ready else 0.0)

    def _run(self) -> None:
        switching = sys.getswitchinterval()
        sys.setswitchinterval(SWITCHING)
        try:
            if self._is_prepared():
                with without_long_pauses():
                    self._fly_on()
        finally:
            sys.setswitchinterval(switching)

    def _is_prepared(self) -> bool:
        """Prepare the flight, with faster code on its way; whether that could be done."""
        try:
            self.prepare()
            self._flight.optimise()
        except Exception as error:
            log.error("error: the flight cannot be flown: %s", error, exc_info=not isinstance(error, InputError))
            self._preparing.failure = str(error) if isinstance(error, InputError) else repr(error)
            return False
        return True

    def _fly_on(self) -> None:
        self.pace.begin()
        while not self._stopping.is_set():
            with self._lock:
                steps = self._fly(min(self.pace.due(), BATCH))
            time.sleep(NAP if steps < BATCH else BREATH)

    def _fly(self, steps: int) -> int:
        """Fly some steps, as far as the flight goes; how many."""
        before = self._flight.step
        try:
            while self._flight.step < before + steps and not self._flight.over and not self._failed:
                self._forget_wishes()
                self._flight.advance()
                for watch in self.watchers:
                    watch(self._flight)
            if steps == 0:
                self._flight.rest()
        except Exception:
            self._failed = True  # until a reset
            log.exception("the flight ended by an error")
        flown = self._flight.step - before
        self.pace.flew(flown)
        return flown

    # what is shown

    def frame(self) -> bytes:
        """The latest state, as the scene's `fields` say."""
        if not self.is_ready:
            return self._framing.first()
        with self._lock:
            moment, hand, seq, framing = self._flight.moment, self._flight.hand, self._grip.seq, self._framing
        held = {"held": hand.held, "hand_point": hand.grip, "hand_target": hand.target, "push_point": hand.grip}
        return framing.frame({**framing.values(*moment), **held, "seq": seq % 2**24})

    def channels(self) -> dict[str, Any]:
        """The channels of the latest sample (1, …)."""
        return dict(channels_of(self._flight.layout, self._flight.sample[None, :].copy()))

    def _values(self) -> dict[str, Any]:
        return self._framing.values(*self._flight.moment)

    def status(self) -> dict[str, Any]:
        """Phase, alarm, pace and what was recorded, for people; before, what is being prepared."""
        if not self.is_ready:
            return self._preparing.status()
        with self._lock:
            flight, pace, values = self._flight, self.pace, self._values()
            most, pace.most_behind = pace.most_behind, 0.0
            return {
                "phase": self._phase(int(values["phase"][0])),
                "alarm": self._names[int(values["alarm"][0])] if "alarm" in values else "",
                "enabled": bool(flight.hand.enabled),
                "paused": pace.paused,
                "speed": pace.speed,
                "factor": round(pace.factor, 3),
                "behind_ms": round(1e3 * most, 2),
                "recorded_s": round(flight.step * flight.dt, 3),
                "dead": dead_rotors(flight),
            }

    def _phase(self, number: int) -> str:
        ends = {"failed": self._failed, "lost": self._flight.lost, "over": self._flight.over}
        return next((name for name, true in ends.items() if true), PHASES[number])

    # what a page says

    def apply(self, message: messages.Message, seq: int) -> Any:
        """Heed a message; what there is to answer: a dictionary, several, or None.

        Raises:
            InputError: it cannot be done; the text says why.
        """
        if not self.is_ready:
            raise InputError(self._preparing.refusal)
        with self._lock:
            if isinstance(message, (messages.Grab, messages.Move, messages.Release, messages.Force)):
                self._grip.seq = seq
        return self._heed(message)

    def release(self) -> None:
        """Nobody holds the beam any more."""
        if self.is_ready:
            with self._lock:
                self._move(held=0.0, force=ZERO)

    def _move(self, **changes: Any) -> None:
        self._flight.hold(self._flight.hand._replace(**changes))

    def _forget_wishes(self) -> None:
        if ended := self._grip.ended(self._flight.step):
            self._move(**dict.fromkeys(ended, 0.0))

    @singledispatchmethod
    def _heed(self, message: Any) -> Any:
        raise InputError(f"{message.type}: nothing here heeds it")

    @_heed.register
    def _grab(self, m: messages.Grab) -> None:
        with self._lock:
            check_touch(self._flight, self._framing.scene, m.point)
            point, attitude = Vec3(*m.point), Quat(*map(float, self._values()["attitude"][0]))
            arm = apply(rotation_from_quaternion(attitude), point)
            centre = m.at == "centre"
            self._grip.offset = -arm if centre else ZERO
            target = Vec3(*m.target) + self._grip.offset
            self._move(held=1.0, grip=ZERO if centre else point, target=target)

    @_heed.register
    def _pull(self, m: messages.Move) -> None:
        with self._lock:
            if self._flight.hand.held:
                self._move(target=Vec3(*m.target) + self._grip.offset)

    @_heed.register
    def _let_go(self, m: messages.Release) -> None:
        self.release()

    @_heed.register
    def _push(self, m: messages.Force) -> None:
        with self._lock:
            force = Vec3(*m.force)
            if any(force):
                check_touch(self._flight, self._framing.scene, m.point)
            grip = {"grip": Vec3(*m.point)} if any(force) and not self._flight.hand.held else {}
            self._move(force=force, **grip)

    @_heed.register
    def _ask(self, m: messages.Ask) -> None:
        check_listens(self._mission, m.what)
        with self._lock:
            self._move(**{m.what: 1.0})
            if m.what != "stop":
                self._grip.wishes[m.what] = self._flight.step + round(WISH / self._flight.dt)

    @_heed.register
    def _enable(self, m: messages.Enable) -> None:
        check_listens(self._mission, "enable")
        with self._lock:
            self._move(enabled=float(m.on))

    @_heed.register
    def _pause(self, m: messages.Pause) -> None:
        with self._lock:
            self.pace.paused = m.on

    @_heed.register
    def _slow_down(self, m: messages.Speed) -> None:
        with self._lock:
            self.pace.speed = m.factor

    @_heed.register
    def _reset(self, m: messages.Reset) -> None:
        with self._knobs.turn:
            again = renewed(self._flight.now, self._mission)
            ready = ready_of(again, self._engine)
            self._begin(again, ready, Framing(again, self._engine, ready))
            self.generation += 1

    @_heed.register
    def _save(self, m: messages.Save) -> dict[str, Any]:
        with self._lock:
            snapshot = self._flight.snapshot()
        folder = self._out / m.name
        save_aside(snapshot, folder)
        return {"type": "done", "what": "save", "detail": str(folder)}

    @_heed.register
    def _tare(self, m: messages.Tare) -> dict[str, Any]:
        with self._lock:
            check_may_tare(self._flight, self._phase(int(self._values()["phase"][0])))
        return {"type": "done", "what": "tare", "detail": self._knobs.tare(self._flight)}

    @_heed.register
    def _kill(self, m: messages.Kill) -> None:
        self._knobs.kill(self._flight, m.rotor)

    @_heed.register
    def _set(self, m: messages.Set) -> list[dict[str, Any]]:
        value = list(m.value) if isinstance(m.value, tuple) else m.value
        return self._with_scene(self._knobs.set(self._flight, m.key, value))

    @_heed.register
    def _restore(self, m: messages.Restore) -> list[dict[str, Any]]:
        return self._with_scene(self._knobs.restore(self._flight, m.key))

    def _with_scene(self, told: list[dict[str, Any]]) -> list[dict[str, Any]]:
        """What to tell of changes; after a choice, also the controls, which may be others now."""
        chosen = any(one["type"] == "changed" and one["key"] in CHOICES for one in told)
        return [*told, {"type": "scene", **self.scene}] if chosen else told
