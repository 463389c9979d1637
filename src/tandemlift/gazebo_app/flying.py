"""A Gazebo of its own for a flight: with a window to watch and push it in, and with cameras that photograph it."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

from tandemlift.common.errors import InputError
from tandemlift.engines.gazebo import PORT, REAL_TIME, world_of
from tandemlift.engines.gazebo_server import GazeboServer, command, free_port, in_gazebo, root
from tandemlift.gazebo_app.camera_views import ViewRequest
from tandemlift.models.cameras import PICTURES, add_cameras
from tandemlift.settings import Mission

EVERY = 0.5  # s, from one picture of a camera to the next
PATIENCE = 60.0  # s, until every camera has drawn for the first time
GLANCE = 0.1  # s, between looks whether it has
WAITING = "<wait>true</wait>", "<wait>false</wait>"  # a world that waits for its pilot draws nothing meanwhile


class Photo(NamedTuple):
    """A picture as it was taken: what it is of, the time [s] of the flight just after it, and its JPEG."""

    shot: ViewRequest
    time: float
    jpeg: bytes


class GazeboSession:
    """A server for a flight to come.

    Args:
        mission: what will be flown.
        shots: pictures to be taken.
        window: whether to open Gazebo's window.

    Attributes:
        master: address of Gazebo's own transport.
        port: of the plugin, UDP.
        photos: taken so far.

    Raises:
        InputError: there is no Gazebo, no display for a window, or its cameras draw nothing.
    """

    def __init__(self, mission: Mission, shots: Sequence[ViewRequest] = (), *, window: bool = False) -> None:
        self.photos: list[Photo] = []
        self._due, self.port = list(shots), free_port(socket.SOCK_DGRAM)
        text = world_of(mission, self.port)
        if shots:
            text = add_cameras(text.replace(*WAITING), [s.eye for s in shots], EVERY)
        with ExitStack() as closing:
            self._server = GazeboServer(text, draws=bool(shots))
            closing.callback(self._server.close)
            self.master = self._server.master
            if window:
                closing.enter_context(_window(self.master))
            self._await_cameras()
            self._closing = closing.pop_all()

    def _await_cameras(self) -> None:
        until = time.monotonic() + PATIENCE
        while not all(self._taken(shot) for shot in self._due):
            self._server.check()
            if time.monotonic() > until:
                raise InputError(f"Gazebo's cameras draw nothing; is Xvfb installed where it is?{self._server.said()}")
            time.sleep(GLANCE)

    def _taken(self, shot: ViewRequest) -> list[Path]:
        """The pictures of a camera in the order of time; the last may not be whole yet."""
        files = (self._server.folder / PICTURES / shot.eye.name).glob("*.jpg")
        return sorted(files, key=lambda path: int(path.stem.rpartition("-")[2]))

    def look(self, at: float) -> None:
        """Take what is due at a time [s] of the flight; to be called about every second of it."""
        for shot in [s for s in self._due if s.time <= at]:
            files = self._taken(shot)
            if len(files) > 1:
                self._due.remove(shot)
                self.photos.append(Photo(shot, at, files[-2].read_bytes()))

    def close(self) -> None:
        """End the server and its window."""
        self._closing.close()


@contextmanager
def opened(
    mission: Mission, shots: Sequence[ViewRequest] = (), *, window: bool = False, real_time: bool = False
) -> Iterator[GazeboSession]:
    """A Gazebo that engine `gazebo` joins meanwhile; arguments and errors as of `GazeboSession`."""
    gazebo, before = (
        GazeboSession(mission, shots, window=window),
        {name: os.environ.get(name) for name in (PORT, REAL_TIME)},
    )
    os.environ |= {PORT: str(gazebo.port), REAL_TIME: str(int(real_time))}
    try:
        yield gazebo
    finally:
        gazebo.close()
        for name, value in before.items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value


def has_display() -> bool:
    """Whether there is a screen for a window."""
    return bool(os.environ.get("DISPLAY"))


@contextmanager
def _window(master: str) -> Iterator[None]:
    """Gazebo's window on a server, while it is needed."""
    if not has_display():
        raise InputError("Gazebo's window needs a display: DISPLAY is not set")
    inside, allowed = root(), Path(os.environ.get("XAUTHORITY", Path.home() / ".Xauthority"))
    with ExitStack() as closing:
        if inside and allowed.is_file():  # the cookie of this display, where the window will look for it
            cookie = inside / "tmp" / f"tandemlift-{os.getpid()}.cookie"
            shutil.copy(allowed, cookie)
            closing.callback(cookie.unlink)
            allowed = Path("/tmp") / cookie.name
        show = f"export DISPLAY={os.environ['DISPLAY']} XAUTHORITY={allowed}; exec gzclient"
        quiet = subprocess.DEVNULL
        client = subprocess.Popen(
            command(inside, in_gazebo(master, show)), stdin=quiet, stdout=quiet, stderr=quiet, start_new_session=True
        )
        try:
            yield
        finally:
            client.kill()
            client.wait()
