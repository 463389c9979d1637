"""`tandemlift ros`: a flight in real time that speaks ROS."""

from __future__ import annotations

import signal
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.live import DEFAULT, session_of
from tandemlift.cli.run import DIVERGED, echo, load
from tandemlift.common.errors import InputError
from tandemlift.ros.sample_queue import every_of

if TYPE_CHECKING:
    from tandemlift.live.session.session import Session
    from tandemlift.ros.middleware import Middleware

BAD_ENDS = ("lost", "failed")


@click.command()
@click.argument("words", nargs=-1, metavar="[MISSION] [NAME:=VALUE]...")
@click.option("--engine", default="compiled", show_default=True, help="Where the body lives; see `tandemlift engines`.")
@click.option("--version", type=click.Choice(["1", "2"]), help="Of ROS.  [default: 1 if there is rospy, else 2]")
@click.option("--rate", type=float, default=100.0, show_default=True, help="Of samples [Hz].")
@click.option("--save", metavar="DIR", help="Where to save the flight at its end; it flies again from there.")
@click.option("--rviz", is_flag=True, help="Start ROS 1's RViz beside it, which shows everything.")
@click.option("--folder", is_flag=True, help="Print the folder of the launch file and of RViz's file, and fly nothing.")
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help="Change one key of the mission, as in run.")
def ros(
    words: tuple[str, ...],
    engine: str,
    version: str | None,
    rate: float,
    save: str | None,
    rviz: bool,
    folder: bool,
    settings: tuple[str, ...],
) -> None:
    """Fly MISSION in real time as a node of ROS, and let it be pushed by messages.

    MISSION is the name of a built-in mission (see `tandemlift missions`) or the path of a .toml file; zigzag if none is
    given. Its pushes and its person are left out: who publishes on /tandemlift/push pushes. ROS 1 needs rospy and a
    running roscore; ROS 2 needs no installed ROS, but pip install 'tandemlift[ros2]'. Without --version it is the one
    that is installed. Topics, services and parameters: docs/ros.md. Ctrl-C ends it.

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
    from tandemlift.engines.registry import engine_named
    from tandemlift.ros.ros1 import folder as package
    from tandemlift.ros.selection import middleware_of, version_for

    if folder:
        echo(str(package()))
        return
    if rviz and version == "2":
        raise InputError("--rviz: its file is for ROS 1")
    mission, arguments = _words(words)
    engine_named(engine)
    loaded = load(mission, settings)
    every_of(rate, loaded.mission.step)
    spoken = version_for("1" if rviz else version)
    middleware = middleware_of(spoken, arguments, asked=rviz or version is not None)
    try:
        session = session_of(loaded, engine)
        session.prepare()
        session.flight.optimise()
        end = _fly(session, middleware, rate, f"{mission} in ROS {spoken}", rviz=rviz)
    finally:
        middleware.shutdown()
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


def _fly(session: Session, middleware: Middleware, rate: float, what: str, *, rviz: bool) -> str:
    """Fly until it ends; the phase that it ends in."""
    from tandemlift.ros.node import FlightNode
    from tandemlift.ros.ros1 import start_rviz

    beside = start_rviz() if rviz else None
    front = FlightNode(session, middleware, rate)
    for number in (signal.SIGINT, signal.SIGTERM):  # from roslaunch too, which may have had them ignored
        signal.signal(number, signal.default_int_handler)
    try:
        front.start()
        echo(f"{what}: topics below /tandemlift, pushes by /tandemlift/push; Ctrl-C ends it")
        sys.stdout.flush()
        return front.spin()
    except KeyboardInterrupt:
        echo("stopped")
        return "stopped"
    finally:
        front.stop()
        if beside:
            beside.terminate()


def _save(session: Session, save: str | None) -> None:
    from tandemlift.common.errors import FlightWarning

    if save:
        with warnings.catch_warnings():  # of what may go badly with rotors that may fail
            warnings.simplefilter("ignore", FlightWarning)
            session.flight.snapshot().save(Path(save))
        echo(f"saved: {save}; `tandemlift run {Path(save) / 'recorded.toml'}` flies it again")
