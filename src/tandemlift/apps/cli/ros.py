"""Flights for robots' software: `tandemlift ros`, a node in real time, `gazebo`, and for clients of quadrotors."""

from __future__ import annotations

import sys
import time
from functools import partial
from pathlib import Path
from typing import Any

import click

from tandemlift.apps.cli import flying
from tandemlift.apps.cli.completion import MISSIONS
from tandemlift.apps.cli.console import echo, exit_now, progress_bar
from tandemlift.apps.cli.live import DEFAULT, OUT, no_browser_option, port_option
from tandemlift.apps.cli.run import write_results
from tandemlift.apps.export.results import check_folder, results_folder
from tandemlift.core.errors import InputError, extra

ROS_ARGUMENTS = "--ros-args"


class RosCommand(click.Command):
    """A command that takes what follows `--ros-args`, by which launch files of ROS 2 name, remap and set, as it is."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Keep it from the options."""
        at = args.index(ROS_ARGUMENTS) if ROS_ARGUMENTS in args else len(args)
        ctx.meta[ROS_ARGUMENTS] = args[at:]
        return super().parse_args(ctx, args[:at])


@click.command(cls=RosCommand)
@click.argument("words", nargs=-1, metavar="[MISSION] [NAME:=VALUE]...", shell_complete=MISSIONS)
@flying.engine_option
@click.option(
    "--version",
    type=click.Choice(["1", "2", "2-dds"]),
    help="ROS version; 2: by rclpy where that is, else by DDS, as 2-dds.  [default: 1 if there is only rospy, else 2]",
)
@click.option("--rate", type=float, default=100.0, show_default=True, help="Rate at which samples are published [Hz].")
@click.option("--save", metavar="DIR", help="Save the flight in this folder at its end; `run` can fly it again.")
@click.option("--bag", metavar="DIR", help="Record all topics in this folder while it flies, as a bag of ROS 2 (MCAP).")
@click.option("--rviz", is_flag=True, help="Also start RViz, which shows the vehicle and its surroundings.")
@click.option("--folder", is_flag=True, help="Only print the folder of the launch file and of the RViz configuration.")
@flying.set_option
def ros(
    words: tuple[str, ...],
    engine: str,
    version: str | None,
    rate: float,
    save: str | None,
    bag: str | None,
    rviz: bool,
    folder: bool,
    settings: tuple[str, ...],
) -> None:
    """Fly MISSION in real time as a ROS node that messages push.

    The default is zigzag, the paper's corridor. The mission's own pushes and person are omitted: messages on
    /tandemlift/push push the vehicle. ROS 1 needs rospy and a running roscore. ROS 2 needs no installed ROS, only
    pip install 'tandemlift[ros2]'; where rclpy is installed, the node is one of rclpy, with services and parameters.
    docs/how-to/ros.md describes topics, services and parameters. Ctrl-C ends the flight.

    \b
    Examples:
      tandemlift ros
      tandemlift ros zigzag --rviz --save out/mine
      tandemlift ros hover --set admittance.mass=2 --rate 50
      tandemlift ros zigzag --version 2 --bag out/push

    Exit code 3: crashed, diverged or interrupted, or ROS 1's master is gone; --save saves the flight so far.
    """
    from tandemlift.apps.live.session.two_flights import TwoFlights
    from tandemlift.apps.ros import ros1
    from tandemlift.apps.ros.middleware import recorded, split_words
    from tandemlift.apps.ros.node import fly_and_save, middleware_for, shut_down, version_for
    from tandemlift.apps.ros.sample_queue import steps_between_samples
    from tandemlift.engines.registry import engine_named

    if folder:
        echo(str(ros1.FOLDER))
        return
    mission, arguments = split_words(words, DEFAULT)
    engine_named(engine)
    check_folder("--save", save)
    loaded = flying.load(mission, settings)
    steps_between_samples(rate, loaded.mission.step)
    arguments += click.get_current_context().meta[ROS_ARGUMENTS]
    middleware = middleware_for(version_for(version), arguments, echo, asked=version is not None)
    try:
        with recorded(middleware, bag) as heard:
            session = TwoFlights(loaded, engine, OUT)
            session.prepare()
            session.flight.optimise()
            failures = fly_and_save(session, heard, rate, f"{mission} in {middleware.name}", save, echo, rviz=rviz)
    finally:
        gone = shut_down(middleware)
    for failure in (*failures, *gone):
        click.echo(f"{mission}: {failure}", err=True)
    if failures or gone:
        sys.exit(flying.FAILED)


@click.command()
@click.argument("mission", default=DEFAULT, shell_complete=MISSIONS)
@click.option("--by-hand", is_flag=True, help="Leave out the mission's pushes and person: you push, by a Gazebo topic.")
@click.option("--fast", is_flag=True, help="Fly as fast as possible instead of in real time.")
@click.option("--no-window", is_flag=True, help="Do not open Gazebo's window. Without a display, no window opens.")
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/gazebo/NAME]")
@flying.set_option
@flying.after_crash_option
@flying.figures_option
@flying.strict_option
def gazebo(
    mission: str,
    by_hand: bool,
    fast: bool,
    no_window: bool,
    out: str | None,
    settings: tuple[str, ...],
    after_crash: float | None,
    no_figures: bool,
    strict: bool,
) -> None:
    """Fly MISSION in Gazebo 11, with its window.

    It starts the server, the window, the world and the pilot. The default is zigzag, the paper's corridor. Gazebo must
    be installed on this system, or in a root made by tools/gazebo-root whose path is in TANDEMLIFT_GAZEBO_ROOT. How to
    push is printed; files are those of `tandemlift run`. Ctrl-C ends a flight with --by-hand, which is written as well.

    \b
    Examples:
      tandemlift gazebo
      tandemlift gazebo iris --by-hand
      tandemlift gazebo zigzag --fast --no-window

    Exit code 3: crashed, diverged, interrupted or not lifted; what was flown is written. With --strict, also findings.
    """
    if by_hand and fast:
        raise InputError("--by-hand flies in real time: leave out --fast")
    from tandemlift.apps.cli.gazebo_flight import fly_in_gazebo
    from tandemlift.engines.gazebo import has_display, root

    loaded = flying.load(mission, flying.with_after_crash(settings, after_crash))
    root()  # raises if there is no Gazebo, before anything is compiled
    with results_folder(out, Path("out/gazebo") / loaded.mission.name, flying.FILES, mission) as folder:
        began = time.perf_counter()
        window = has_display() and not no_window
        if not (window or no_window):
            click.echo("No window: DISPLAY is not set", err=True)
        with progress_bar("Flying", "steps", shown=not by_hand) as progress:
            flight = fly_in_gazebo(loaded, echo, progress, by_hand=by_hand, window=window, real_time=not fast)
        recording = None if by_hand else loaded.person.recording
        write_results(flight, folder, began, recording, figures=not no_figures)
    flying.exit_if_amiss({flight.name: flight}, strict=strict)


own_loops_option = click.option("--own-loops", is_flag=True, help="Each quadrotor has its own rate loops: they fight.")


@click.command()
@click.argument("mission", default="crazyflie-stick", shell_complete=MISSIONS)
@click.option("--udp-port", type=int, default=19850, show_default=True, help="UDP port of the first Crazyflie.")
@own_loops_option
@flying.engine_option
@port_option
@no_browser_option
@flying.set_option
def crazyflie(mission: str, udp_port: int, **options: Any) -> None:
    """Fly MISSION in real time, each quadrotor as a Crazyflie.

    Bitcraze's cflib finds them by scanning, or as udp://127.0.0.1:19850, :19851 and so on; scripts for real ones fly
    the simulated ones unchanged. The live page shows the same flight, and pushes it. The mission's own pushes, person
    and pilot are omitted. docs/how-to/fly-with-crazyflie-clients.md lists what is simulated. Ctrl-C ends the flight.

    \b
    Examples:
      tandemlift crazyflie
      tandemlift crazyflie crazyflie-stick --set wind.velocity=[1,0,0]
    """
    from tandemlift.apps.clients.crazyflie.server import CrazyflieServer

    _fly_by_clients(mission, partial(CrazyflieServer, port=udp_port), **options)


@click.command()
@click.argument("mission", default="two-x500", shell_complete=MISSIONS)
@click.option("--udp-port", type=int, default=14540, show_default=True, help="UDP port of the first one's clients.")
@click.option(
    "--autopilot",
    type=click.Choice(["generic", "px4"]),
    default="generic",
    show_default=True,
    help="Named in heartbeats: with px4, pymavlink and MAVProxy know the modes by name.",
)
@own_loops_option
@flying.engine_option
@port_option
@no_browser_option
@flying.set_option
def mavlink(mission: str, udp_port: int, autopilot: str, **options: Any) -> None:
    """Fly MISSION in real time, each quadrotor as a MAVLink vehicle.

    Scripts for MAVSDK fly them unchanged, those for pymavlink with --autopilot px4. What they fly is simulated. Clients
    of the first one listen on udpin://0.0.0.0:14540, of the second one on :14541. The live page shows the same flight,
    and pushes it. The mission's own pushes, person and pilot are omitted. Needs pip install 'tandemlift[mavlink]'.
    docs/how-to/fly-with-mavlink.md has modes and parameters. Ctrl-C ends the flight.

    \b
    Examples:
      tandemlift mavlink
      tandemlift mavlink two-x500 --set wind.velocity=[1,0,0]
      tandemlift mavlink --autopilot px4
    """
    with extra("mavlink", "MAVLink"):
        from tandemlift.apps.clients.mavlink.vehicles import MavlinkVehicles

    _fly_by_clients(mission, partial(MavlinkVehicles, port=udp_port, autopilot=autopilot), **options)


def _fly_by_clients(
    mission: str, serve: Any, own_loops: bool, engine: str, port: int, no_browser: bool, settings: tuple[str, ...]
) -> None:
    """Fly in real time by the clients that are served, beside the live page."""
    from tandemlift.apps.clients.flight import PILOT_ASIDE, RealTimeFlight, quadrotors_of
    from tandemlift.apps.live.page_files import page_files
    from tandemlift.apps.live.server import PageServer, serve_until_interrupt

    flown = flying.load(mission, (*PILOT_ASIDE, *settings))
    quadrotors = quadrotors_of(flown, "own" if own_loops else "shared")
    flight = RealTimeFlight(flown, quadrotors, engine, OUT)
    with serve(quadrotors, flight) as server:
        echo(f"Quadrotors: {', '.join(server.addresses)}")
        page = PageServer(page_files(), flight.session, port=port)
        serve_until_interrupt(page, f"{mission}, flown by clients", echo, browser=not no_browser)
    exit_now(0)  # a thread may still be compiling
