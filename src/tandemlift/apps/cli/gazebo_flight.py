"""Gazebo started for one flight, with a window to watch and push it."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from tandemlift import Flight
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.core.errors import InputError
from tandemlift.core.types import Progress
from tandemlift.engines.gazebo import CHECKS, PORT, REAL_TIME, world_from
from tandemlift.engines.gazebo_server import (
    GazeboServer,
    free_port,
    root,
    shell_command,
    shell_command_for_user,
    with_gazebo_environment,
)
from tandemlift.missions import Mission
from tandemlift.simulation.fly import fly
from tandemlift.simulation.recorded_flight import RecordedFlight


@contextmanager
def _joined(port: int, check: Callable[[], None], *, real_time: bool) -> Iterator[None]:
    """A context in which engine `gazebo` joins the server at a port."""
    before = {name: os.environ.get(name) for name in (PORT, REAL_TIME)}
    CHECKS[port] = check
    os.environ |= {PORT: str(port), REAL_TIME: str(int(real_time))}
    try:
        yield
    finally:
        del CHECKS[port]
        for name, value in before.items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value


def gazebo_sentence() -> str:
    """Whether Gazebo can fly the corridor on this machine."""
    how = "`tandemlift gazebo zigzag --fast` flies this corridor in Gazebo 11"
    try:
        root()
    except InputError:
        return f"{how}. Gazebo is not installed on the machine that made this report."
    return f"{how}. Gazebo is installed on the machine that made this report, which flew the compiled engine."


def has_display() -> bool:
    """Whether there is a screen for a window."""
    return bool(os.environ.get("DISPLAY"))


@contextmanager
def _window(master: str) -> Iterator[None]:
    """Gazebo's window on a server, while the context is open."""
    if not has_display():
        raise InputError("Gazebo's window needs a display: DISPLAY is not set")
    inside, allowed = root(), Path(os.environ.get("XAUTHORITY", Path.home() / ".Xauthority"))
    with ExitStack() as closing:
        if inside and allowed.is_file():  # the display's cookie must be inside the root
            cookie = inside / "tmp" / f"tandemlift-{os.getpid()}.cookie"
            shutil.copy(allowed, cookie)
            closing.callback(cookie.unlink)
            allowed = Path("/tmp") / cookie.name
        show = f"export DISPLAY={os.environ['DISPLAY']} XAUTHORITY={allowed}; exec gzclient"
        quiet = subprocess.DEVNULL
        client = subprocess.Popen(
            shell_command(inside, with_gazebo_environment(master, show)),
            stdin=quiet,
            stdout=quiet,
            stderr=quiet,
            start_new_session=True,
        )
        try:
            yield
        finally:
            client.kill()
            client.wait()


@contextmanager
def _stop_signals() -> Iterator[Callable[[], bool]]:
    """A function that returns whether SIGINT or SIGTERM has arrived; neither interrupts a step."""
    received: list[int] = []
    before = {s: signal.signal(s, lambda number, _: received.append(number)) for s in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield lambda: bool(received)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def fly_in_gazebo(
    mission: Mission,
    say: Callable[[str], None],
    progress: Progress | None,
    *,
    by_hand: bool,
    window: bool,
    real_time: bool,
) -> Flight:
    """Fly a mission to its end; or, by hand, without its pushes and its person until Ctrl-C: Gazebo's topic pushes.

    Raises:
        InputError: there is no Gazebo, or no display for the window.
    """
    flown, port = interactive_mission(mission) if by_hand else mission, free_port(socket.SOCK_DGRAM)

    def begun(master: str) -> None:
        push = """gz topic -p /gazebo/default/tandemlift/push -m 'data: "force 2 0 0 point 0 0 0 duration 2"'"""
        say(f"{mission.mission.name} flies in Gazebo. To push it, run in another terminal:")
        say(f"  {shell_command_for_user(master, push)}" + "\n  Ctrl-C ends it" * by_hand)
        sys.stdout.flush()

    with ExitStack() as closing:
        server = GazeboServer(world_from(flown, port))
        closing.callback(server.close)
        if window:
            closing.enter_context(_window(server.master))
        closing.enter_context(_joined(port, server.check, real_time=real_time))
        if not by_hand:
            begun(server.master)
            return fly(flown, "gazebo", progress=progress)
        stopped, recorded = closing.enter_context(_stop_signals()), RecordedFlight(flown, "gazebo")
        begun(server.master)
        while not (stopped() or recorded.over):
            recorded.advance()
        return recorded.snapshot().alone()
