"""Files for use elsewhere: `tandemlift export`, `compile` and `render`.

A saved flight becomes a ROS bag or a table, a mission a model or code for other machines, and both a picture or an
animation, drawn without a display.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from tandemlift.apps.cli.completion import FLIGHTS_AND_MISSIONS, MISSIONS, names
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.cli.flying import controller_option, engine_option, load, set_option, setting_option
from tandemlift.apps.cli.run import fly_mission
from tandemlift.apps.export.results import flight_file
from tandemlift.core.errors import InputError

CAMERAS = "follow, overview, front, side, top, or AZIMUTH,ELEVATION[,DISTANCE] in degrees and metres"


@click.command()
@click.argument("flight_or_mission", shell_complete=FLIGHTS_AND_MISSIONS)
@click.option("--out", metavar="FILE", required=True, help="FILE.mcap, .bag, .csv, .sdf, .xml or .urdf.")
@setting_option
@click.option(
    "--plugin",
    metavar="PORT|ros",
    help="For FILE.sdf: connect a pilot by a plugin of Gazebo. Parts of your own: the key `plugins` of the mission.",
)
def export(flight_or_mission: str, out: str, settings: tuple[str, ...], plugin: str | None) -> None:
    """Write a flight or a mission for other tools.

    \b
    A flight:               .mcap  ROS 2 bag     .bag  ROS 1 bag     .csv  table
    A flight or a mission:  .sdf   Gazebo world  .xml  MuJoCo model  .urdf  robot of ROS

    The ending of FILE selects the format. FLIGHT_OR_MISSION is a saved flight (flight.npz or its folder) or a mission.
    Bags need rosbags (pip install 'tandemlift[export]'), MuJoCo models mujoco. docs/reference/flights.md has the files.

    \b
    Examples:
      tandemlift export out/iris --out iris.mcap
      tandemlift export out/iris/flight.npz --out iris.bag
      tandemlift export zigzag --out zigzag.sdf
      tandemlift export four --set initial.euler=0.0 --out four.xml
    """
    from tandemlift.apps.export import write as exporting
    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission

    path = Path(out)
    model = exporting.is_model(path)
    _, saved = flight_file(flight_or_mission)
    if settings and (saved or not model):
        raise InputError(
            "--set is for a mission that is written to FILE.sdf, .xml or .urdf; a saved flight cannot be changed"
        )
    if not saved and not model:
        raise InputError(f"{flight_or_mission} is no saved flight: give flight.npz or the folder of a run")
    what = Flight.load(saved) if saved else load(flight_or_mission, settings)
    exporting.export(what, path, plugin=int(plugin) if plugin and plugin.isdecimal() else plugin)
    size = path.stat().st_size
    name = what.mission.name if isinstance(what, Mission) else what.name
    echo(f"{name}: {path} ({f'{size / 1e3:.0f} kB' if model else f'{size / 1e6:.1f} MB'})")


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option("--target", required=True, shell_complete=names("target"), help="wasm32, c, fmu, aarch64 or cortex-m7.")
@click.option("--out", metavar="DIR", help="Folder for the files; by default out/NAME-TARGET.")
@click.option("--single", is_flag=True, help="For C: compute in single precision.")
@click.option("--fmi", type=click.IntRange(2, 3), help="For FMUs: version of FMI.  [default: 2]")
@click.option("--platforms", metavar="A,B,…", help="For FMUs: linux, linux-arm64, windows, macos.  [default: this one]")
@set_option
@controller_option()
def compile(
    mission: str, target: str, out: str | None, settings: tuple[str, ...], controller: str | None, **how: Any
) -> None:
    """Compile a mission for another machine.

    \b
    wasm32     NAME.wasm, without imports, for browsers and Node.js
    c          C99 sources with CMake: the pilot alone, and the whole flight
    fmu        NAME_pilot.fmu, NAME_vehicle.fmu, NAME_flight.fmu for Simulink and other tools
    aarch64    NAME.o for 64-bit ARM with Linux
    cortex-m7  NAME.o for microcontrollers with double precision

    Pilot, body and loop compute the same bits everywhere. The code takes the numbers of a mission file: masses, gains,
    pushes. NAME.json, the manifest, lists them, and a flight's channels. docs/how-to/compile.md shows how to call it.

    \b
    Examples:
      tandemlift compile iris --target wasm32
      tandemlift compile iris --target c --single --out pilot
      tandemlift compile iris --target fmu --fmi 3 --platforms linux,windows,macos
      tandemlift compile zigzag --target aarch64 --set vehicle.payload.mass=0.6
      tandemlift compile hover --target c --controller my_pd.py
    """
    from tandemlift.codegen.mission_module import compile_mission

    what = load(mission, settings, controller)
    folder = Path(out) if out else Path("out") / f"{what.mission.name}-{target}"
    how["platforms"] = None if how["platforms"] is None else how["platforms"].split(",")
    for path in compile_mission(what, target, folder, **how):
        echo(f"{path} ({path.stat().st_size / 1e3:.0f} kB)")


@click.command()
@click.argument("flight_or_mission", shell_complete=FLIGHTS_AND_MISSIONS)
@click.option("--out", metavar="FILE", help="FILE.png, FILE.gif or FILE.mp4.  [default: picture.png beside the flight]")
@click.option("--time", type=float, help="Time of the picture [s].  [default: that of the strongest push]")
@click.option("--from", type=float, help="Start of the animation [s].")
@click.option("--to", type=float, help="End of the animation [s].")
@click.option("--fps", type=float, help="Frames per second of the animation, 1 to 50.  [default: 20]")
@click.option("--speed", type=float, help="Playback speed.  [default: 1, or faster so that it lasts 20 s]")
@click.option("--size", metavar="WxH", help="Size in pixels.  [default: 1280x720, a GIF 640x360]")
@click.option("--camera", default="follow", show_default=True, metavar="VIEW", help=f"Camera: {CAMERAS}.")
@engine_option
@set_option
def render(
    flight_or_mission: str, out: str | None, camera: str, engine: str, settings: tuple[str, ...], **at: Any
) -> None:
    """Draw a flight: a picture (PNG) or an animation (GIF, MP4).

    FLIGHT_OR_MISSION is a saved flight (flight.npz or its folder), or a mission, which is flown first. --engine and
    --set are for a mission only.

    \b
    Examples:
      tandemlift render out/paper
      tandemlift render out/paper --out push.png --time 34 --camera overview
      tandemlift render out/paper --out pushes.gif --from 20 --to 40 --speed 2
      tandemlift render out/paper --out pushes.mp4 --from 20 --to 40 --fps 30
      tandemlift render hover --set mission.duration=5 --out hover.gif
    """
    from tandemlift.flight.record import Flight
    from tandemlift.pictures.drawing import film

    folder, saved = flight_file(flight_or_mission)
    if saved and (settings or engine != "compiled"):
        raise InputError(f"--set, --engine: {saved} is a saved flight, which cannot be changed: give a mission")
    path = Path(out) if out else folder / "picture.png"
    size, view = film.size_of(at.pop("size")), film.camera_of(camera)
    film.check_options(path, [f"--{name}" for name, value in at.items() if value is not None])
    shot = film.Shot(at["time"], at["from"], at["to"], at["fps"] or 20.0, at["speed"], size, view)
    flight = Flight.load(saved) if saved else fly_mission(load(flight_or_mission, settings), engine)
    with progress_bar("Drawing", "pictures", shown=path.suffix.lower() != ".png") as progress:
        film.render(flight, path, shot, progress)
    echo(f"{flight.name}: {path}")
