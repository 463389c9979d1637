"""`tandemlift gazebo`: a mission in Gazebo, with its window and its cameras."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.live import DEFAULT
from tandemlift.cli.results import bar, keep_recording, results_in, write_results
from tandemlift.cli.run import DIVERGED, echo, load, say_report, summarise
from tandemlift.common.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tandemlift.flight.record import Flight
    from tandemlift.gazebo_app.flying import GazeboSession, Photo
    from tandemlift.missions import Mission


@click.command()
@click.argument("mission", default=DEFAULT)
@click.option("--by-hand", is_flag=True, help="Leave its pushes and its person out: you push, on Gazebo's topic.")
@click.option("--fast", is_flag=True, help="As fast as it can, not in real time.")
@click.option("--no-window", is_flag=True, help="Without Gazebo's window; there is none without a display either.")
@click.option("--pictures", is_flag=True, help="Four views by Gazebo's own cameras, as in the paper's Figure 9.")
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/gazebo/NAME]")
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help="Change one key of the mission, as in run.")
@click.option("--no-figures", is_flag=True, help="Leave the figures out.")
def gazebo(
    mission: str,
    by_hand: bool,
    fast: bool,
    no_window: bool,
    pictures: bool,
    out: str | None,
    settings: tuple[str, ...],
    no_figures: bool,
) -> None:
    """Fly MISSION in Gazebo 11: server, window, world and pilot at once.

    MISSION is the name of a built-in mission (see `tandemlift missions`) or the path of a .toml file; zigzag, the
    paper's corridor, if none is given. Gazebo must be installed, or be in a root that tools/gazebo-root made, which
    TANDEMLIFT_GAZEBO_ROOT names. How to push is printed. Written is the same as by `tandemlift run`; a flight by hand
    ends by Ctrl-C, and is written too.

    \b
    Examples:
      tandemlift gazebo
      tandemlift gazebo iris --by-hand
      tandemlift gazebo zigzag --pictures --fast --no-window

    \b
    Exit code:
      0   flown
      2   bad input: one message, nothing is written
      3   diverged: the flight until then is written
    """
    if by_hand and (fast or pictures):
        raise InputError(
            f"--by-hand: is in real time and has no pictures; leave {'--fast' if fast else '--pictures'} out"
        )
    from tandemlift.engines.gazebo_server import root

    loaded = load(mission, settings)
    root()  # complains if there is no Gazebo, before anything is compiled
    with results_in(out, Path("out/gazebo") / loaded.mission.name) as folder:
        began = time.perf_counter()
        window = not no_window and _has_display()
        flight, views = _by_hand(loaded, window) if by_hand else _as_it_is(loaded, window, not fast, pictures)
        summarise(flight)
        if not by_hand:
            keep_recording(loaded, folder)
        write_results(flight, folder, figures=not no_figures, views=views)
        say_report(folder, time.perf_counter() - began)
    if flight.divergence:
        click.echo(f"{flight.name}: {flight.divergence}", err=True)
        sys.exit(DIVERGED)


def _has_display() -> bool:
    from tandemlift.gazebo_app.flying import has_display

    if not has_display():
        click.echo("No window: DISPLAY is not set", err=True)
    return has_display()


def _as_it_is(mission: Mission, window: bool, real_time: bool, pictures: bool) -> tuple[Flight, Figure | None]:
    """Fly a mission to its end; the flight, and its pictures if they are wanted."""
    from tandemlift.gazebo_app.camera_views import shots_of
    from tandemlift.gazebo_app.flying import opened
    from tandemlift.simulation.fly import fly

    shots, step = shots_of(fly(mission)) if pictures else [], mission.mission.step
    with opened(mission, shots, window=window, real_time=real_time) as gazebo:
        _tell_how_to_push(mission, gazebo)
        with bar("Flying", mission.mission.steps) as progress:

            def look(done: int, total: int) -> None:
                gazebo.look(done * step)
                if progress:
                    progress(done, total)

            flight = fly(mission, "gazebo", progress=look)
        return flight, _views(gazebo.photos) if pictures else None


def _views(photos: Sequence[Photo]) -> Figure | None:
    from tandemlift.figures.views import draw

    if not photos:
        return None
    return draw([(f"{p.shot.title}, {p.shot.time:.0f} s", p.jpeg) for p in photos])


def _by_hand(mission: Mission, window: bool) -> tuple[Flight, None]:
    """Fly a mission that nobody but Gazebo's topic pushes, until Ctrl-C."""
    from tandemlift.gazebo_app.flying import opened
    from tandemlift.live.session.interactive_mission import interactive_mission
    from tandemlift.simulation.recorded_flight import RecordedFlight

    mission = interactive_mission(mission)
    with opened(mission, window=window, real_time=True) as gazebo, _until_stopped() as stopped:
        recorded = RecordedFlight(mission, "gazebo")
        _tell_how_to_push(mission, gazebo)
        echo("  Ctrl-C ends it")
        while not (stopped() or recorded.over):
            recorded.advance()
        return recorded.snapshot().alone(), None


@contextmanager
def _until_stopped() -> Iterator[Callable[[], bool]]:
    """Whether Ctrl-C, or a word to end, has come; neither breaks off a step."""
    came: list[int] = []
    before = {s: signal.signal(s, lambda number, _: came.append(number)) for s in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield lambda: bool(came)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _tell_how_to_push(mission: Mission, gazebo: GazeboSession) -> None:
    from tandemlift.engines.gazebo_server import by_yourself

    push = """gz topic -p /gazebo/default/tandemlift/push -m 'data: "force 2 0 0 point 0 0 0 duration 2"'"""
    echo(f"{mission.mission.name}, in Gazebo; to push it, in another terminal:")
    echo(f"  {by_yourself(gazebo.master, push)}")
    sys.stdout.flush()
