"""`tandemlift render`: a picture or an animation of a flight, drawn without a display."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.results import bar, flight_file
from tandemlift.cli.run import echo, parse_setting
from tandemlift.common.errors import InputError

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight
    from tandemlift.rendering import Shot

CAMERAS = "follow, overview, front, side, top, or AZIMUTH,ELEVATION[,DISTANCE] in degrees and metres"
OF_PICTURE, OF_ANIMATION = ("--time",), ("--from", "--to", "--fps", "--speed")


@click.command()
@click.argument("flight_or_mission")
@click.option("--out", metavar="FILE", help="FILE.png or FILE.gif.  [default: picture.png beside the flight]")
@click.option("--time", type=float, help="Of a picture [s].  [default: when the push is strongest]")
@click.option("--from", "start", type=float, help="Start of an animation [s].")
@click.option("--to", "end", type=float, help="End of an animation [s].")
@click.option("--fps", type=float, help="Pictures a second of an animation, 1 to 50.  [default: 20]")
@click.option("--speed", type=float, help="Of an animation.  [default: to last 20 s at most]")
@click.option("--size", metavar="WxH", help="Pixels.  [default: 1280x720 for a picture, 640x360 for an animation]")
@click.option("--camera", default="follow", show_default=True, metavar="VIEW", help=f"One of {CAMERAS}.")
@click.option("--engine", default="compiled", show_default=True, help="Of a mission that is flown for this.")
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help="Change one key of such a mission.")
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
    """Draw a flight: a picture (PNG) or an animation (GIF).

    FLIGHT_OR_MISSION is a saved flight (flight.npz, or the folder that it is in), of any engine, or a mission to fly.

    \b
    Examples:
      tandemlift render out/paper
      tandemlift render out/paper --out push.png --time 34 --camera overview
      tandemlift render out/paper --out pushes.gif --from 20 --to 40 --speed 2
      tandemlift render hover --set mission.duration=5 --out hover.gif
    """
    from tandemlift import rendering

    folder, saved = flight_file(flight_or_mission)
    path = Path(out) if out else folder / "picture.png"
    given = {"--time": time, "--from": start, "--to": end, "--fps": fps, "--speed": speed}
    _check_options(path, [name for name, value in given.items() if value is not None])
    view = rendering.camera_of(camera)
    shot = rendering.Shot(time, start, end, fps or 20.0, speed, _size(size), view)
    flight = _load(saved) if saved else _fly(flight_or_mission, settings, engine)
    _draw(flight, path, shot)


def _check_options(path: Path, given: list[str]) -> None:
    """Refuse what does not go with the kind of file.

    Raises:
        InputError: an option has no meaning for it, or the file is of no known kind.
    """
    kind = path.suffix.lower()
    if kind not in (".png", ".gif"):
        raise InputError(f"--out {path}: a picture's name ends in .png, an animation's in .gif")
    wrong = [name for name in given if name in (OF_ANIMATION if kind == ".png" else OF_PICTURE)]
    if wrong:
        other = "an animation, --out FILE.gif" if kind == ".png" else "a picture, --out FILE.png"
        raise InputError(f"{', '.join(wrong)} {'are' if len(wrong) > 1 else 'is'} for {other}")


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
    from tandemlift.missions import load_mission
    from tandemlift.simulation.fly import fly

    engine_named(engine)
    loaded = load_mission(mission, dict(map(parse_setting, settings)))
    with bar("Flying", loaded.mission.steps, shown=sys.stderr.isatty()) as progress:
        return fly(loaded, engine, progress=progress)


def _draw(flight: Flight, path: Path, shot: Shot) -> None:
    from tandemlift import rendering

    if path.suffix.lower() == ".png":
        rendering.render(flight, path, shot)
    else:
        count = len(rendering.Animation(flight, shot))
        with bar("Drawing", count, shown=sys.stderr.isatty()) as progress:
            rendering.render(flight, path, shot, progress)
    echo(f"{flight.name}: {path}")
