"""`tandemlift ros`: a flight in real time that speaks ROS."""

from __future__ import annotations

import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.run import DIVERGED, parse_setting, say
from tandemlift.errors import InputError

if TYPE_CHECKING:
    from tandemlift.live.session import Session
    from tandemlift.ros.middleware import Middleware
    from tandemlift.settings import Mission

DEFAULT = "zigzag"
BAD_ENDS = ("lost", "failed")


@click.command()
@click.argument("words", nargs=-1, metavar="[MISSION] [NAME:=VALUE]...")
@click.option("--engine", default="compiled", show_default=True, help="Where the body lives; see `tandemlift engines`.")
@click.option("--version", type=click.Choice(["1", "2"]), default="1", show_default=True, help="Of ROS.")
@click.option("--rate", type=float, default=100.0, show_default=True, help="Of samples [Hz].")
@click.option("--save", metavar="DIR", help="Where to save the flight at its end; it flies again from there.")
@click.option("--rviz", is_flag=True, help="Start RViz beside it, which shows everything.")
@click.option("--folder", is_flag=True, help="Print the folder of the launch file and of RViz's file, and fly nothing.")
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help="Change one key of the mission, as in run.")
def ros(
    words: tuple[str, ...],
    engine: str,
    version: str,
    rate: float,
    save: str | None,
    rviz: bool,
    folder: bool,
    settings: tuple[str, ...],
) -> None:
    """Fly MISSION in real time, tell it in ROS, and let it be pushed by messages.

    MISSION is the name of a built-in mission (see `tandemlift missions`) or the path of a .toml file; zigzag if none is
    given. Its pushes and its person are left out: who publishes on /tandemlift/push pushes. ROS 1 needs rospy and a
    running roscore; ROS 2 needs no installed ROS. Topics, services and parameters: docs/ros.md. Ctrl-C ends it.

    \b
    Examples:
      tandemlift ros
      tandemlift ros zigzag --rviz --save out/mine
      tandemlift ros hover --set admittance.mass=2 --rate 50
      tandemlift ros zigzag --version 2

    \b
    Exit code:
      0   ended by Ctrl-C, by ROS, or an hour of flight
      2   bad input: one message, nothing is flown
      3   the vehicle was lost
    """
    from tandemlift.engines import engine_named
    from tandemlift.ros.package import folder as package
    from tandemlift.ros.package import start_rviz

    if folder:
        say(str(package()))
        return
    mission, arguments = _words(words)
    engine_named(engine)
    loaded = _load(mission, settings)
    middleware = _middleware(version, arguments)
    session = _session(loaded, engine, save)
    beside = start_rviz(version) if rviz else None
    try:
        end = _fly(session, middleware, rate, f"{mission} in ROS {version}")
    finally:
        if beside:
            beside.terminate()
    _save(session, save)
    if end in BAD_ENDS:
        click.echo(f"{mission}: {end}", err=True)
        sys.exit(DIVERGED)


def _words(words: tuple[str, ...]) -> tuple[str, list[str]]:
    """The mission, and ROS's own arguments."""
    arguments = [word for word in words if ":=" in word]
    missions = [word for word in words if ":=" not in word] or [DEFAULT]
    if len(missions) > 1:
        raise InputError(f"{' '.join(missions)}: one mission is flown at a time")
    return missions[0], arguments


def _load(mission: str, settings: tuple[str, ...]) -> Mission:
    from tandemlift.missions import load_mission

    return load_mission(mission, dict(map(parse_setting, settings)))


def _middleware(version: str, arguments: list[str]) -> Middleware:
    if version == "1":
        from tandemlift.ros.ros1 import Ros1

        return Ros1(arguments)
    from tandemlift.ros.ros2 import Ros2

    return Ros2()


def _session(mission: Mission, engine: str, save: str | None) -> Session:
    """The flight, compiled; who waits for that is told."""
    from tandemlift.live.by_hand import by_hand
    from tandemlift.live.session import Session
    from tandemlift.prepared import needs_compiling

    if needs_compiling(by_hand(mission)):
        click.echo("Compiling the flight loop for this machine (once, a minute or two) …", err=True)
    return Session(mission, engine, Path(save or ".").parent)


def _fly(session: Session, middleware: Middleware, rate: float, what: str) -> str:
    """Fly until it ends; the phase that it ends in."""
    from tandemlift.ros.front import Front

    front = Front(session, middleware, rate)
    for number in (signal.SIGINT, signal.SIGTERM):  # from roslaunch too, which may have had them ignored
        signal.signal(number, signal.default_int_handler)
    try:
        front.start()
        say(f"{what}: topics below /tandemlift, pushes by /tandemlift/push; Ctrl-C ends it")
        sys.stdout.flush()
        return front.spin()
    except KeyboardInterrupt:
        say("stopped")
        return "stopped"
    finally:
        front.stop()
        middleware.shutdown()


def _save(session: Session, save: str | None) -> None:
    if save:
        session.flight.snapshot().save(Path(save))
        say(f"saved: {save}; `tandemlift run {Path(save) / 'recorded.toml'}` flies it again")
