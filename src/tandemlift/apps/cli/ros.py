"""`tandemlift ros`: a flight in real time as a ROS node."""

from __future__ import annotations

import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.live import DEFAULT, session_of
from tandemlift.apps.cli.terminal.completion import MISSIONS
from tandemlift.apps.cli.terminal.console import echo
from tandemlift.apps.cli.terminal.mission_options import FAILED, engine_option, load, set_option
from tandemlift.core.errors import InputError, without_flight_warnings

if TYPE_CHECKING:
    from tandemlift.apps.live.session.session import Session
    from tandemlift.apps.ros.middleware import Middleware


@click.command()
@click.argument("words", nargs=-1, metavar="[MISSION] [NAME:=VALUE]...", shell_complete=MISSIONS)
@engine_option
@click.option(
    "--version", type=click.Choice(["1", "2"]), help="ROS version.  [default: 1 if rospy is installed, else 2]"
)
@click.option("--rate", type=float, default=100.0, show_default=True, help="Rate at which samples are published [Hz].")
@click.option("--save", metavar="DIR", help="Save the flight in this folder at its end; `run` can fly it again.")
@click.option("--rviz", is_flag=True, help="Also start RViz (ROS 1), which shows the vehicle and its surroundings.")
@click.option("--folder", is_flag=True, help="Only print the folder of the launch file and of the RViz configuration.")
@set_option
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
    """Fly MISSION in real time as a ROS node that messages push.

    MISSION is a built-in mission (see `tandemlift missions`) or the path of a .toml file. The default is zigzag, the
    paper's corridor. The mission's own pushes and person are omitted: messages on /tandemlift/push push the vehicle.
    ROS 1 needs rospy and a running roscore. ROS 2 needs no installed ROS, only pip install 'tandemlift[ros2]'.
    docs/how-to/ros.md describes topics, services and parameters. Ctrl-C ends the flight.

    \b
    Examples:
      tandemlift ros
      tandemlift ros zigzag --rviz --save out/mine
      tandemlift ros hover --set admittance.mass=2 --rate 50
      tandemlift ros zigzag --version 2

    \b
    Exit code:
      0   ended by Ctrl-C, by ROS, or after an hour of flight
      2   bad input: one message, nothing is flown
      3   crashed, diverged or interrupted, or ROS 1's master is gone: the flight so far is saved with --save
    """
    from tandemlift.apps.ros.node import middleware_for, version_for
    from tandemlift.apps.ros.ros1 import folder as package
    from tandemlift.apps.ros.ros2 import KILTED
    from tandemlift.apps.ros.sample_queue import steps_between_samples
    from tandemlift.engines.registry import engine_named

    if folder:
        echo(str(package()))
        return
    if rviz and version == "2":
        raise InputError("--rviz: needs ROS 1, not --version 2")
    mission, arguments = _split_arguments(words)
    engine_named(engine)
    loaded = load(mission, settings)
    steps_between_samples(rate, loaded.mission.step)
    spoken = version_for("1" if rviz else version)
    middleware = middleware_for(spoken, arguments, asked=rviz or version is not None)
    try:
        session = session_of(loaded, engine)
        session.prepare()
        session.flight.optimise()
        if spoken == "2":
            echo(KILTED)
        failures = _fly_and_save(session, middleware, rate, f"{mission} in ROS {spoken}", save, rviz=rviz)
    finally:
        gone = _shut_down(middleware)
    for failure in (*failures, *gone):
        click.echo(f"{mission}: {failure}", err=True)
    if failures or gone:
        sys.exit(FAILED)


def _split_arguments(words: tuple[str, ...]) -> tuple[str, list[str]]:
    """The mission, and the arguments for ROS itself."""
    arguments = [word for word in words if ":=" in word]
    missions = [word for word in words if ":=" not in word] or [DEFAULT]
    if len(missions) > 1:
        raise InputError(f"{' '.join(missions)}: give one mission only")
    return missions[0], arguments


def _fly_and_save(
    session: Session, middleware: Middleware, rate: float, what: str, save: str | None, *, rviz: bool
) -> list[str]:
    """Fly until the flight ends, and save it whatever the reason; return the reason of a failure, if any."""
    try:
        end = _fly(session, middleware, rate, what, rviz=rviz)
    except BaseException:
        if session.flight.step > 1:
            _save(session, save)
        raise
    _save(session, save)
    ending = session.flight.ending
    return [str(ending or end)] if ending or end == "failed" else []


def _fly(session: Session, middleware: Middleware, rate: float, what: str, *, rviz: bool) -> str:
    """Fly until the flight ends; its last phase."""
    from tandemlift.apps.ros.node import FlightNode
    from tandemlift.apps.ros.ros1 import start_rviz

    beside = start_rviz() if rviz else None
    front = FlightNode(session, middleware, rate)
    for number in (signal.SIGINT, signal.SIGTERM):  # roslaunch may have set them to be ignored
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


def _shut_down(middleware: Middleware) -> list[str]:
    """Disconnect from ROS; return a message if it is gone."""
    try:
        middleware.shutdown()
    except OSError as error:
        return [str(error)]
    return []


def _save(session: Session, save: str | None) -> None:
    if save:
        with without_flight_warnings():  # the mission was checked when it was loaded
            session.flight.snapshot().save(Path(save))
        echo(f"saved: {save}; `tandemlift run {Path(save) / 'recorded.toml'}` flies it again")
