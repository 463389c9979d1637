"""The messages between a pilot and the plugin in Gazebo (`gazebo/tandemlift_gazebo.cc`), over UDP on loopback.

A message is a header (magic, version, kind, session, number of quadrotors, sequence number) and a fixed number of
doubles, little-endian. The pilot sends and the plugin answers: HELLO by WELCOME, STEP k by STATE k. The pilot repeats a
message that is not answered. The plugin answers a repeated STEP by the same STATE, and accepts no other STEP than the
next. So a packet that is lost, doubled or late never moves the world twice.
"""

from __future__ import annotations

import contextlib
import secrets
import socket
import struct
import time
from collections.abc import Callable
from enum import IntEnum, IntFlag

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.errors import InputError

MAGIC, VERSION = 0x5A474C54, 2
HEADER = struct.Struct("<IHHIIQ")
SEQUENCE = struct.Struct("<Q")
AT_SEQUENCE, AT_KIND = 16, 6  # bytes
DOUBLE = 8  # bytes
STATE = 13  # numbers of a state
LARGEST_MESSAGE = 65536  # bytes
FIRST_RESEND, SLOWEST_RESEND = 0.02, 0.5  # s, shortest and longest wait before a message is repeated
GONE = 1.0  # s, in which a plugin that nobody listens for in flight is given up, and a server that ends has ended


class MessageKind(IntEnum):
    """Kinds of messages."""

    HELLO = 1
    WELCOME = 2
    STEP = 3
    STATE = 4
    BYE = 5
    REFUSE = 6


class HelloRequest(IntFlag):
    """Requests of a HELLO: place the vehicle at a state; run in real time."""

    NOTHING = 0
    PLACE = 1
    REAL_TIME = 2


REFUSALS = {
    1: "it speaks another version of the protocol",
    2: "its vehicle has another number of quadrotors",
    3: "it cannot read the message",
    4: "a number in the message is not finite",
    5: "the session is over: Gazebo has dropped this pilot, or another one has connected",
}


class PluginAnswer:
    """An answer of the plugin, as views of one array that the next answer overwrites.

    Attributes:
        clock: (3,) time [s] and step [s] of the world, mass of its vehicle [kg].
        state: (13,) as `registry.EngineBody.state`.
        readings: (6 + 6N,) as `registry.EngineBody.readings`.
        touches: (2, 5N + 1, 4) of the floor, then of walls: of every rotor, every guard and the beam the normal force
            [N] over the last step, and the place of the strongest contact [m, world axes]; zeros without contact.
        pushed: (6,) as `registry.PushedBody.pushed`.
    """

    def __init__(self, count: int) -> None:
        self.numbers = np.zeros(answer_size(count))
        ends = [3, 3 + STATE, 3 + STATE + 6 + 6 * count, -6]
        self.clock, self.state, self.readings, touches, self.pushed = np.split(self.numbers, ends)
        self.touches = touches.reshape(2, 5 * count + 1, 4)


def step_size(count: int) -> int:
    """Numbers of a STEP of N quadrotors."""
    return 10 * count + 12


def answer_size(count: int) -> int:
    """Numbers of a WELCOME or STATE of N quadrotors."""
    return 3 + STATE + 6 + 6 * count + 8 * (5 * count + 1) + 6


class Wire:
    """The pilot's end of the connection.

    Args:
        port: UDP port of the plugin on this machine.
        count: N, the number of quadrotors.
        patience: time without an answer after which the session fails [s].
        alive: called while no answer arrives; raises if the server has ended.

    Attributes:
        thrusts, wrench, loads: parts of the next STEP, set by the caller: thrusts (4N,) [N]; force [N, world axes] and
            moment [N·m, body axes] at the vehicle's centre of mass (6,); the numbers of a `PartLoads` (6 + 6N,).
        answer: the last answer.
    """

    def __init__(self, port: int, count: int, patience: float = 5.0, alive: Callable[[], None] | None = None) -> None:
        self.port, self.count, self.patience, self.answer = port, count, patience, PluginAnswer(count)
        self._alive = alive or (lambda: None)
        self._session, self._sequence = 0, 0
        self._step = bytearray(HEADER.size + DOUBLE * step_size(count))
        step = np.frombuffer(self._step, dtype=np.float64, offset=HEADER.size)
        self.thrusts, self.wrench, self.loads = np.split(step, [4 * count, 4 * count + 6])
        self._received = bytearray(LARGEST_MESSAGE)
        self._answer_size = HEADER.size + DOUBLE * answer_size(count)
        self._numbers = np.frombuffer(self._received, dtype=np.float64, offset=HEADER.size, count=answer_size(count))
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect(("127.0.0.1", port))

    def hello(
        self, dt: float, rotors: ArrayLike, state: ArrayLike | None = None, real_time: bool = False
    ) -> PluginAnswer:
        """Begin a session.

        Args:
            dt: the mission's step [s].
            rotors: (3, 4N) x [m], y [m] from each quadrotor's centre of mass, signed torque over thrust [m].
            state: (13,) to place the vehicle in; if None, the vehicle stays where it is.
            real_time: whether the world runs in real time; otherwise as fast as possible.

        Raises:
            InputError: the plugin refuses.
            TimeoutError: nothing answers.
        """
        asked = (HelloRequest.NOTHING if state is None else HelloRequest.PLACE) | (
            HelloRequest.REAL_TIME if real_time else HelloRequest.NOTHING
        )
        place = np.array([0.0] * 6 + [1.0] + [0.0] * 6) if state is None else state
        content = np.concatenate([[float(asked), dt], np.ravel(place), np.ravel(rotors)])
        self._session, self._sequence = secrets.randbits(32), 0
        self._request(self._head(MessageKind.HELLO) + content.tobytes(), MessageKind.WELCOME)
        self._step[: HEADER.size] = self._head(MessageKind.STEP)
        return self.answer

    def advance(self) -> PluginAnswer:
        """Send the step, and wait until the world has taken it.

        Raises:
            ConnectionError: the session is over, or the server has ended.
            TimeoutError: nothing answers.
        """
        self._sequence += 1
        SEQUENCE.pack_into(self._step, AT_SEQUENCE, self._sequence)
        self._request(self._step, MessageKind.STATE)
        return self.answer

    def keep_alive(self) -> None:
        """Tell the plugin that the pilot is alive: repeat the last message without waiting for the answer."""
        with contextlib.suppress(OSError):
            self._socket.send(self._step)
            while self._socket.recv_into(self._received, 0, socket.MSG_DONTWAIT):
                pass

    def close(self) -> None:
        """End the session and close the socket."""
        with contextlib.suppress(OSError):  # the server has ended already
            self._socket.send(self._head(MessageKind.BYE))
        self._socket.close()

    def _head(self, kind: MessageKind) -> bytes:
        return HEADER.pack(MAGIC, VERSION, kind, self._session, self.count, self._sequence)

    def _request(self, message: bytes | bytearray, answer: MessageKind) -> None:
        """Send a message, again and again, until its answer is in `answer`."""
        wait, deadline, gone = FIRST_RESEND, time.monotonic() + self.patience, False
        while time.monotonic() < deadline:
            try:
                self._socket.send(message)
                self._socket.settimeout(wait)
                while not self._receive(answer):
                    if time.monotonic() > deadline:
                        raise TimeoutError
                self.answer.numbers[:] = self._numbers
                return
            except TimeoutError:
                wait = min(2.0 * wait, SLOWEST_RESEND)
            except ConnectionRefusedError:  # nothing listens at the port: not yet, or not any more
                gone = answer == MessageKind.STATE
                deadline = min(deadline, time.monotonic() + GONE) if gone else deadline
                time.sleep(wait)
            self._alive()
        if gone:
            raise ConnectionError(
                f"engine 'gazebo': nothing listens at UDP port {self.port} any more: Gazebo has ended"
            )
        raise TimeoutError(
            f"engine 'gazebo': the plugin on UDP port {self.port} did not answer within {self.patience:g} s "
            f"({MessageKind(message[AT_KIND]).name} {self._sequence}); is the world paused, or has Gazebo ended?"
        )

    def _receive(self, answer: MessageKind) -> bool:
        """Receive one message; whether it is the expected answer."""
        size = self._socket.recv_into(self._received)
        if size < HEADER.size:
            return False
        magic, version, kind, session, count, sequence = HEADER.unpack_from(self._received)
        if magic != MAGIC or session != self._session:
            return False
        if kind == MessageKind.REFUSE:
            self._raise_refusal(version, count, sequence)
        return bool(version == VERSION and kind == answer and sequence == self._sequence and size == self._answer_size)

    def _raise_refusal(self, version: int, count: int, sequence: int) -> None:
        """Raise the error that a refusal states, unless it answers another message."""
        if sequence != self._sequence:
            return
        if version != VERSION:
            raise InputError(
                f"engine 'gazebo': the plugin speaks version {version} of the protocol, this is version {VERSION}: "
                "build the plugin of this tandemlift (docs/how-to/gazebo.md)"
            )
        if count != self.count:
            raise InputError(
                f"engine 'gazebo': the vehicle in Gazebo has {count} quadrotors, the mission's has {self.count}"
            )
        why = REFUSALS.get(int(self._numbers[0]), "it does not say why")
        raise ConnectionError(f"engine 'gazebo': the plugin refuses step {self._sequence}: {why}")
