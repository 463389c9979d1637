"""`tandemlift render`: a picture or an animation of a flight, drawn without a display."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.terminal.completion import FLIGHTS_AND_MISSIONS
from tandemlift.apps.cli.terminal.console import echo, progress_bar
from tandemlift.apps.cli.terminal.mission_options import engine_option, load, set_option
from tandemlift.apps.cli.terminal.results import flight_file
from tandemlift.core.errors import InputError

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight
    from tandemlift.pictures.rendering import Shot

CAMERAS = "follow, overview, front, side, top, or AZIMUTH,ELEVATION[,DISTANCE] in degrees and metres"
PICTURE_OPTIONS, ANIMATION_OPTIONS = ("--time",), ("--from", "--to", "--fps", "--speed")


@click.command()
@click.argument("flight_or_mission", shell_complete=FLIGHTS_AND_MISSIONS)
@click.option("--out", metavar="FILE", help="FILE.png, FILE.gif or FILE.mp4.  [default: picture.png beside the flight]")
@click.option("--time", type=float, help="Time of the picture [s].  [default: that of the strongest push]")
@click.option("--from", "start", type=float, help="Start of the animation [s].")
@click.option("--to", "end", type=float, help="End of the animation [s].")
@click.option("--fps", type=float, help="Frames per second of the animation, 1 to 50.  [default: 20]")
@click.option(
    "--speed",
    type=float,
    help="Playback speed.  [default: 1, or faster so that it lasts 20 s]",
)
@click.option("--size", metavar="WxH", help="Size in pixels.  [default: 1280x720, a GIF 640x360]")
@click.option("--camera", default="follow", show_default=True, metavar="VIEW", help=f"Camera: {CAMERAS}.")
@engine_option
@set_option
def render(
    flight_or_mission: str,
    out: str | None,
    time: float | None,
    start: float | None,
    end: float | None,
    fps: float | None,
    speed: float | None,
    size: str | None,
    camera: str,
    engine: str,
    settings: tuple[str, ...],
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
    from tandemlift.pictures import rendering

    folder, saved = flight_file(flight_or_mission)
    path = Path(out) if out else folder / "picture.png"
    given = {"--time": time, "--from": start, "--to": end, "--fps": fps, "--speed": speed}
    _check_options(path, [name for name, value in given.items() if value is not None])
    view = rendering.camera_of(camera)
    shot = rendering.Shot(time, start, end, fps or 20.0, speed, _size(size), view)
    flight = _load(saved) if saved else _fly(flight_or_mission, settings, engine)
    _draw(flight, path, shot)


def _check_options(path: Path, given: list[str]) -> None:
    """Reject options that do not fit the kind of file, and kinds that cannot be drawn here, before any flight.

    Raises:
        InputError: an option does not fit the kind of file, the kind is unknown, or nothing here can draw it.
    """
    from tandemlift.pictures.rendering.studio import pyvista
    from tandemlift.pictures.rendering.video import ffmpeg

    kind = path.suffix.lower()
    if kind not in (".png", ".gif", ".mp4"):
        raise InputError(f"--out {path}: the name must end in .png (picture), .gif or .mp4 (animation)")
    wrong = [name for name in given if name in (ANIMATION_OPTIONS if kind == ".png" else PICTURE_OPTIONS)]
    if wrong:
        other = "an animation, --out FILE.gif or FILE.mp4" if kind == ".png" else "a picture, --out FILE.png"
        raise InputError(f"{', '.join(wrong)} {'are' if len(wrong) > 1 else 'is'} for {other}")
    pyvista()
    if kind == ".mp4":
        ffmpeg()


def _size(text: str | None) -> tuple[int, int] | None:
    """Width and height from WxH."""
    if text is None:
        return None
    if not re.fullmatch(r"\d{1,5}x\d{1,5}", text):
        raise InputError(f"--size {text}: must be WxH in pixels, such as 1280x720")
    width, height = map(int, text.split("x"))
    return width, height


def _load(path: Path) -> Flight:
    from tandemlift.flight.record import Flight

    return Flight.load(path)


def _fly(mission: str, settings: tuple[str, ...], engine: str) -> Flight:
    from tandemlift.engines.registry import engine_named
    from tandemlift.simulation.fly import fly

    engine_named(engine)
    loaded = load(mission, settings)
    with progress_bar("Flying", "steps", shown=sys.stderr.isatty()) as progress:
        return fly(loaded, engine, progress=progress)


def _draw(flight: Flight, path: Path, shot: Shot) -> None:
    from tandemlift.pictures import rendering

    if path.suffix.lower() == ".png":
        rendering.render(flight, path, shot)
    else:
        with progress_bar("Drawing", "pictures", shown=sys.stderr.isatty()) as progress:
            rendering.render(flight, path, shot, progress)
    echo(f"{flight.name}: {path}")
