"""The messages between a pilot and the plugin in Gazebo (`gazebo/tandemlift_gazebo.cc`), over UDP on loopback.

A message is a header (magic, version, kind, session, number of quadrotors, sequence number) and a fixed number of
doubles, little-endian. The pilot asks and the plugin answers: HELLO by WELCOME, STEP k by STATE k. What is not answered
is sent again; the plugin answers a STEP that it has taken already by the same STATE, and takes no other than the next.
So a packet that is lost, doubled or late moves nothing, or once.
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

from tandemlift.common.errors import InputError

MAGIC, VERSION = 0x5A474C54, 1
HEADER = struct.Struct("<IHHIIQ")
SEQUENCE = struct.Struct("<Q")
AT_SEQUENCE, AT_KIND = 16, 6  # bytes
DOUBLE = 8  # bytes
STATE = 13  # numbers of a state
LARGEST = 65536  # bytes
FIRST_RESEND, SLOWEST_RESEND = 0.02, 0.5  # s


class MessageKind(IntEnum):
    """What a message is."""

    HELLO = 1
    WELCOME = 2
    STEP = 3
    STATE = 4
    BYE = 5
    REFUSE = 6


class HelloRequest(IntFlag):
    """What a hello asks for: to place the vehicle at a state, to go on in real time."""

    NOTHING = 0
    PLACE = 1
    REAL_TIME = 2


REFUSALS = {
    1: "it speaks another version of the protocol",
    2: "its vehicle has another number of quadrotors",
    3: "it cannot read the message",
    4: "a number in the message is not finite",
    5: "the session is over: it has given this pilot up, or another one has said hello",
}


class PluginAnswer:
    """What the plugin tells, as views of one array that the next answer overwrites.

    Attributes:
        clock: (3,) time [s] and step [s] of the world, mass of its vehicle [kg].
        state: (13,) as `engines.Body.state`.
        felt: (6 + 6N,) as `engines.Body.felt`.
        pushed: (6,) force [N, world axes] and moment about the centre of mass [N·m, body axes] of pushes by topic.
    """

    def __init__(self, count: int) -> None:
        self.numbers = np.zeros(answer_size(count))
        self.clock, self.state, self.felt, self.pushed = np.split(self.numbers, [3, 3 + STATE, -6])


def hello_size(count: int) -> int:
    """Numbers of a HELLO to N quadrotors."""
    return 2 + STATE + 12 * count


def step_size(count: int) -> int:
    """Numbers of a STEP of N quadrotors."""
    return 10 * count + 12


def answer_size(count: int) -> int:
    """Numbers of a WELCOME or STATE of N quadrotors."""
    return 3 + STATE + 6 + 6 * count + 6


class Wire:
    """A pilot's end.

    Args:
        port: UDP port of the plugin on this machine.
        count: N, the number of quadrotors.
        patience: seconds after which a silent plugin is given up.
        alive: called while nothing is heard; raises if the server has ended.

    Attributes:
        thrusts, wrench, loads: parts of the next STEP, to be filled in: thrusts (4N,) [N]; force [N, world axes] and
            moment [N·m, body axes] at the vehicle's centre of mass (6,); the numbers of a `Loads` (6 + 6N,).
        told: the last answer.
    """

    def __init__(self, port: int, count: int, patience: float = 5.0, alive: Callable[[], None] | None = None) -> None:
        self.port, self.count, self.patience, self.told = port, count, patience, PluginAnswer(count)
        self._alive = alive or (lambda: None)
        self._session, self._sequence = 0, 0
        self._step = bytearray(HEADER.size + DOUBLE * step_size(count))
        step = np.frombuffer(self._step, dtype=np.float64, offset=HEADER.size)
        self.thrusts, self.wrench, self.loads = np.split(step, [4 * count, 4 * count + 6])
        self._heard = bytearray(LARGEST)
        self._answer = HEADER.size + DOUBLE * answer_size(count)
        self._numbers = np.frombuffer(self._heard, dtype=np.float64, offset=HEADER.size, count=answer_size(count))
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect(("127.0.0.1", port))

    def hello(
        self, dt: float, rotors: ArrayLike, state: ArrayLike | None = None, real_time: bool = False
    ) -> PluginAnswer:
        """Begin a session.

        Args:
            dt: the mission's step [s].
            rotors: (3, 4N) x [m], y [m] from each quadrotor's centre of mass, signed torque over thrust [m].
            state: (13,) to place the vehicle in; where it is, if not given.
            real_time: whether the world goes on in real time; else as fast as it can.

        Raises:
            InputError: the plugin refuses.
            TimeoutError: nothing answers.
        """
        asked = (HelloRequest.NOTHING if state is None else HelloRequest.PLACE) | (
            HelloRequest.REAL_TIME if real_time else HelloRequest.NOTHING
        )
        place = np.array([0.0] * 6 + [1.0] + [0.0] * 6) if state is None else state
        said = np.concatenate([[float(asked), dt], np.ravel(place), np.ravel(rotors)])
        assert said.size == hello_size(self.count)
        self._session, self._sequence = secrets.randbits(32), 0
        self._ask(self._head(MessageKind.HELLO) + said.tobytes(), MessageKind.WELCOME)
        self._step[: HEADER.size] = self._head(MessageKind.STEP)
        return self.told

    def advance(self) -> PluginAnswer:
        """Send the step, and wait until the world has taken it.

        Raises:
            ConnectionError: the session is over, or the server has ended.
            TimeoutError: nothing answers.
        """
        self._sequence += 1
        SEQUENCE.pack_into(self._step, AT_SEQUENCE, self._sequence)
        self._ask(self._step, MessageKind.STATE)
        return self.told

    def keep(self) -> None:
        """Say that the pilot lives, without a step: the last one again, whose answer is not waited for."""
        with contextlib.suppress(OSError):
            self._socket.send(self._step)
            while self._socket.recv_into(self._heard, 0, socket.MSG_DONTWAIT):
                pass

    def close(self) -> None:
        """Say goodbye, and hang up."""
        with contextlib.suppress(OSError):  # it is gone already
            self._socket.send(self._head(MessageKind.BYE))
        self._socket.close()

    def _head(self, kind: MessageKind) -> bytes:
        return HEADER.pack(MAGIC, VERSION, kind, self._session, self.count, self._sequence)

    def _ask(self, message: bytes | bytearray, answer: MessageKind) -> None:
        """Send a message, again and again, until its answer is in `told`."""
        wait, deadline = FIRST_RESEND, time.monotonic() + self.patience
        while time.monotonic() < deadline:
            try:
                self._socket.send(message)
                self._socket.settimeout(wait)
                while not self._hears(answer):
                    if time.monotonic() > deadline:
                        raise TimeoutError
                self.told.numbers[:] = self._numbers
                return
            except TimeoutError:
                wait = min(2.0 * wait, SLOWEST_RESEND)
            except ConnectionRefusedError:  # nobody has the port, or not yet
                time.sleep(wait)
            self._alive()
        raise TimeoutError(
            f"engine 'gazebo': the plugin on UDP port {self.port} did not answer within {self.patience:g} s "
            f"({MessageKind(message[AT_KIND]).name} {self._sequence}); is the world paused, or Gazebo gone?"
        )

    def _hears(self, answer: MessageKind) -> bool:
        """Take one message off the wire; whether it is the answer."""
        size = self._socket.recv_into(self._heard)
        if size < HEADER.size:
            return False
        magic, version, kind, session, count, sequence = HEADER.unpack_from(self._heard)
        if magic != MAGIC or session != self._session:
            return False
        if kind == MessageKind.REFUSE:
            self._refused(version, count, sequence)
        return bool(version == VERSION and kind == answer and sequence == self._sequence and size == self._answer)

    def _refused(self, version: int, count: int, sequence: int) -> None:
        """Raise what a refusal says, unless it answers another message."""
        if sequence != self._sequence:
            return
        if version != VERSION:
            raise InputError(
                f"engine 'gazebo': the plugin speaks version {version} of the protocol, this is version {VERSION}: "
                "build the plugin of this tandemlift (docs/gazebo.md)"
            )
        if count != self.count:
            raise InputError(
                f"engine 'gazebo': the vehicle in Gazebo has {count} quadrotors, the mission's has {self.count}"
            )
        why = REFUSALS.get(int(self._numbers[0]), "it does not say why")
        raise ConnectionError(f"engine 'gazebo': the plugin refuses step {self._sequence}: {why}")
