"""`tandemlift gazebo`: fly a mission in Gazebo, with its window and its cameras."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.live import DEFAULT
from tandemlift.apps.cli.run import print_report_path, print_summary
from tandemlift.apps.cli.terminal.completion import MISSIONS
from tandemlift.apps.cli.terminal.console import echo, progress_bar
from tandemlift.apps.cli.terminal.findings import exit_if_found, print_findings, strict_option
from tandemlift.apps.cli.terminal.mission_options import FAILED, after_crash_option, load, set_option, with_after_crash
from tandemlift.apps.cli.terminal.results import copy_recording, results_folder, write_flight
from tandemlift.core.errors import InputError

if TYPE_CHECKING:
    from tandemlift.apps.ros.gazebo_flight import GazeboSession
    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission

Photographs = list[tuple[str, bytes]]


@click.command()
@click.argument("mission", default=DEFAULT, shell_complete=MISSIONS)
@click.option("--by-hand", is_flag=True, help="Leave out the mission's pushes and person: you push, by a Gazebo topic.")
@click.option("--fast", is_flag=True, help="Fly as fast as possible instead of in real time.")
@click.option("--no-window", is_flag=True, help="Do not open Gazebo's window. Without a display, no window opens.")
@click.option(
    "--pictures", is_flag=True, help="Take four photographs with Gazebo's cameras, as in the paper's Figure 9."
)
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/gazebo/NAME]")
@set_option
@after_crash_option
@click.option("--no-figures", is_flag=True, help="Draw no figures.")
@strict_option
def gazebo(
    mission: str,
    by_hand: bool,
    fast: bool,
    no_window: bool,
    pictures: bool,
    out: str | None,
    settings: tuple[str, ...],
    after_crash: float | None,
    no_figures: bool,
    strict: bool,
) -> None:
    """Fly MISSION in Gazebo 11: start the server, the window, the world and the pilot.

    MISSION is a built-in mission (see `tandemlift missions`) or the path of a .toml file. The default is zigzag, the
    paper's corridor. Gazebo must be installed on this system, or in a root made by tools/gazebo-root whose path is in
    TANDEMLIFT_GAZEBO_ROOT. The command prints how to push, and writes the same files as `tandemlift run`. Ctrl-C ends
    a flight with --by-hand, which is written as well.

    \b
    Examples:
      tandemlift gazebo
      tandemlift gazebo iris --by-hand
      tandemlift gazebo zigzag --pictures --fast --no-window

    \b
    Exit code:
      0   the flight was flown; findings are on standard error, a line each
      2   bad input: one message, nothing is written
      3   crashed, diverged, interrupted or not lifted: the flight so far is written; with --strict, also findings
    """
    if by_hand and (fast or pictures):
        raise InputError(
            f"--by-hand flies in real time and takes no pictures: leave out {'--fast' if fast else '--pictures'}"
        )
    from tandemlift.engines.gazebo_server import root

    loaded = load(mission, with_after_crash(settings, after_crash))
    root()  # raises if there is no Gazebo, before anything is compiled
    with results_folder(out, Path("out/gazebo") / loaded.mission.name) as folder:
        began = time.perf_counter()
        window = not no_window and _has_display()
        flight, photographs = (
            _fly_by_hand(loaded, window) if by_hand else _fly_to_end(loaded, window, not fast, pictures)
        )
        print_summary(flight)
        if not by_hand:
            copy_recording(loaded.person.recording, folder)
        write_flight(flight, folder, figures=not no_figures, photographs=photographs)
        print_report_path(folder, time.perf_counter() - began)
    count = print_findings([(flight.name, flight)])
    if flight.failure:
        click.echo(f"{flight.name}: {flight.failure}", err=True)
        sys.exit(FAILED)
    exit_if_found(count, strict=strict)


def _has_display() -> bool:
    from tandemlift.apps.ros.gazebo_flight import has_display

    if not has_display():
        click.echo("No window: DISPLAY is not set", err=True)
    return has_display()


def _fly_to_end(mission: Mission, window: bool, real_time: bool, pictures: bool) -> tuple[Flight, Photographs]:
    """Fly a mission to its end; the flight, and its photographs if requested, each with its title."""
    from tandemlift.apps.ros.gazebo_cameras import views_from
    from tandemlift.apps.ros.gazebo_flight import running_gazebo
    from tandemlift.simulation.fly import fly

    views, step = views_from(fly(mission)) if pictures else [], mission.mission.step
    with running_gazebo(mission, views, window=window, real_time=real_time) as gazebo:
        _print_how_to_push(mission, gazebo)
        with progress_bar("Flying", "steps") as progress:

            def take_photographs(done: int, total: int) -> None:
                gazebo.take_due_photographs(done * step)
                if progress:
                    progress(done, total)

            flight = fly(mission, "gazebo", progress=take_photographs)
        return flight, [(f"{p.view.title}, {p.view.time:.0f} s", p.jpeg) for p in gazebo.photos]


def _fly_by_hand(mission: Mission, window: bool) -> tuple[Flight, Photographs]:
    """Fly a mission without its own pushes until Ctrl-C; pushes come by Gazebo's topic."""
    from tandemlift.apps.live.session.interactive_mission import interactive_mission
    from tandemlift.apps.ros.gazebo_flight import running_gazebo
    from tandemlift.simulation.recorded_flight import RecordedFlight

    mission = interactive_mission(mission)
    with running_gazebo(mission, window=window, real_time=True) as gazebo, _stop_signals() as stopped:
        recorded = RecordedFlight(mission, "gazebo")
        _print_how_to_push(mission, gazebo)
        echo("  Ctrl-C ends it")
        while not (stopped() or recorded.over):
            recorded.advance()
        return recorded.snapshot().alone(), []


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


def _print_how_to_push(mission: Mission, gazebo: GazeboSession) -> None:
    from tandemlift.engines.gazebo_server import shell_command_for_user

    push = """gz topic -p /gazebo/default/tandemlift/push -m 'data: "force 2 0 0 point 0 0 0 duration 2"'"""
    echo(f"{mission.mission.name} flies in Gazebo. To push it, run in another terminal:")
    echo(f"  {shell_command_for_user(gazebo.master, push)}")
    sys.stdout.flush()
