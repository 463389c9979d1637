"""Gazebo started for one flight, with a window to watch and push it."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

from tandemlift import Flight
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.core.errors import InputError
from tandemlift.core.types import Progress
from tandemlift.engines.gazebo import root, running_gazebo, shell_command_for_user
from tandemlift.missions import Mission
from tandemlift.simulation.fly import fly
from tandemlift.simulation.recorded_flight import RecordedFlight


def gazebo_sentence() -> str:
    """Whether Gazebo can fly the corridor on this machine."""
    how = "`tandemlift gazebo zigzag --fast` flies this corridor in Gazebo 11"
    try:
        root()
    except InputError:
        return f"{how}. Gazebo is not installed on the machine that made this report."
    return f"{how}. Gazebo is installed on the machine that made this report, which flew the compiled engine."


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
    flown = interactive_mission(mission) if by_hand else mission

    def begun(master: str) -> None:
        push = """gz topic -p /gazebo/default/tandemlift/push -m 'data: "force 2 0 0 point 0 0 0 duration 2"'"""
        say(f"{mission.mission.name} flies in Gazebo. To push it, run in another terminal:")
        say(f"  {shell_command_for_user(master, push)}" + "\n  Ctrl-C ends it" * by_hand)
        sys.stdout.flush()

    with ExitStack() as closing:
        master = closing.enter_context(running_gazebo(flown, window=window, real_time=real_time))
        if not by_hand:
            begun(master)
            return fly(flown, "gazebo", progress=progress)
        stopped, recorded = closing.enter_context(_stop_signals()), RecordedFlight(flown, "gazebo")
        begun(master)
        while not (stopped() or recorded.over):
            recorded.advance()
        return recorded.snapshot().alone()
