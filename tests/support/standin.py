"""A stand-in for a live flight: a damped mass on the spring of a hand, in its own thread."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
from patience import PATIENCE, joined

from tandemlift.apps.live.session.frames import layout_for, pack_frames
from tandemlift.apps.live.session.page_messages import PageMessage
from tandemlift.apps.live.session.scene_builder import SPRING, scene_of
from tandemlift.core.errors import InputError
from tandemlift.missions import load_mission

STEP, MASS, DAMPING = 0.002, 2.0, 6.0


class StandIn:
    """Handles messages for the beam, one parameter, reset and save; records every message."""

    def __init__(self, mission: str = "hover", *, wait: threading.Event | None = None) -> None:
        self.mission = load_mission(mission)
        parameters = [{"key": "admittance.mass", "label": "virtual mass", "value": [1.0], "min": [0.1], "max": [9.0]}]
        self.scene = {**scene_of(self.mission, "compiled"), "parameters": parameters}
        self.fields = layout_for(8)
        self.generation, self.steps, self.released = 0, 0, 0
        self.heard: list[PageMessage] = []
        self._wait = wait  # for which changes wait
        self._lock, self._over = threading.Lock(), threading.Event()
        self._thread = threading.Thread(target=self._fly, name="stand-in", daemon=True)
        self._x, self._v = np.zeros(3), np.zeros(3)
        self._target: np.ndarray | None = None
        self._force, self._seq = np.zeros(3), 0

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._over.set()
        joined(self._thread)

    def _fly(self) -> None:
        while not self._over.is_set():
            with self._lock:
                pull = self._force if self._target is None else SPRING["stiffness"] * (self._target - self._x)
                self._v += STEP * (pull - DAMPING * self._v) / MASS
                self._x += STEP * self._v
                self.steps += 1
            time.sleep(STEP)

    @property
    def held(self) -> bool:
        return self._target is not None or bool(self._force.any())

    def frame(self) -> bytes:
        with self._lock:
            values: dict[str, Any] = {
                "time": self.steps * STEP,
                "position": self._x,
                "attitude": [1.0, 0.0, 0.0, 0.0],
                "held": float(self.held),
                "hand_target": np.zeros(3) if self._target is None else self._target,
                "seq": self._seq,
            }
            return pack_frames(self.fields, values).tobytes()

    def past(self) -> list[bytes]:
        return []

    def status(self) -> dict[str, Any]:
        return {"phase": "guided", "alarm": "", "paused": False, "speed": 1.0, "factor": 1.0, "behind_ms": 0.0}

    def release(self) -> None:
        with self._lock:
            self.released += 1
            self._target, self._force = None, np.zeros(3)

    def apply(self, message: PageMessage) -> list[Any]:
        if message.type in ("set", "save", "reset") and self._wait:
            assert self._wait.wait(PATIENCE)
        with self._lock:
            self.heard.append(message)
            self._seq = message.seq
            return self._applied(message)

    def _applied(self, message: Any) -> list[Any]:
        match message.type:
            case "grab" | "move":
                self._target = np.array(message.target)
            case "force":
                self._force = np.array(message.force)
            case "release":
                self._target, self._force = None, np.zeros(3)
            case "reset":
                self.generation += 1
                self._x, self._v = np.zeros(3), np.zeros(3)
            case "save":
                return [{"type": "done", "what": "save", "detail": message.name}]
            case "restore":
                keys = [message.key] if message.key else ["admittance.mass", "admittance.damping"]
                return [{"type": "changed", "key": key, "value": [1.0], "duration": 0.0} for key in keys]
            case "set":
                if message.key != "admittance.mass":
                    raise InputError(f"{message.key}: cannot be changed in flight")
                return [{"type": "changed", "key": message.key, "value": message.value, "duration": 0.5}]
        return []
