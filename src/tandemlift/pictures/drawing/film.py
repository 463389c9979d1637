"""Pictures (PNG) and animations (GIF, MP4) of a flight."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from tandemlift.core.errors import InputError
from tandemlift.core.files import atomic_write
from tandemlift.core.types import Array, Progress
from tandemlift.engines.models.visuals import CAMERAS, Camera
from tandemlift.engines.models.visuals import camera_of as camera_of
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.ground import View
from tandemlift.pictures.drawing.second_studio import drawn_by_two
from tandemlift.pictures.drawing.stage import FlightStage
from tandemlift.pictures.drawing.studio import Studio, pyvista
from tandemlift.pictures.drawing.video import check_size, ffmpeg, write_mp4

PICTURE_OPTIONS, ANIMATION_OPTIONS = ("--time",), ("--from", "--to", "--fps", "--speed")
ANGLE = np.radians(30.0)  # of view, vertical [rad]
SIZES = {".png": (1280, 720), ".gif": (640, 360), ".mp4": (1280, 720)}  # pixels
MAX_TIME = 20.0  # s, length of an animation: a longer flight is shown faster, unless a speed is given
PALETTE = ((Image.Quantize.MEDIANCUT, 160), (Image.Quantize.MAXCOVERAGE, 90))  # for fine shades, and for rare colours
CLOSE, LOWER = 3.7, 0.07  # distance / vehicle's reach; offset of the target below the vehicle / distance
FILLED = 0.94  # fraction of the picture that the whole path fills
FOLLOWING = 0.6  # s, window over which a following camera smooths the path
INK = (60, 68, 78)
PIXELS, COUNT = 3840 * 2160, 3000  # largest number of pixels of a picture, and of pictures of an animation


@dataclass(frozen=True)
class Shot:
    """The settings of a film.

    Args:
        time: of a picture [s]; by default the time of the strongest push, or the end of a flight without push.
        start: of an animation [s]; by default the start of the flight.
        end: of an animation [s]; by default the end of the flight.
        fps: pictures per second of an animation; those of a GIF are whole hundredths of a second apart.
        speed: playback speed; by default such that the animation lasts at most 20 s.
        size: width and height in pixels; by default 1280 × 720, of a GIF 640 × 360.
        camera: the point of view.
    """

    time: float | None = None
    start: float | None = None
    end: float | None = None
    fps: float = 20.0
    speed: float | None = None
    size: tuple[int, int] | None = None
    camera: Camera = CAMERAS["follow"]


SHOT = Shot()


class Film:
    """Pictures of a flight from one camera."""

    def __init__(self, flight: Flight, camera: Camera, size: tuple[int, int]) -> None:
        if not (min(size) >= 16 and size[0] * size[1] <= PIXELS):
            raise InputError(f"size {size[0]}x{size[1]} must be at least 16x16 and of at most 3840x2160 pixels")
        self.stage, self._camera = FlightStage(flight), camera
        self._size, self._studio = size, Studio(self.stage, size)
        self._smooth = _smoothed(self.stage.time, self.stage.path)

    def view(self, time: float) -> View:
        """The view at a time [s]."""
        stage, camera = self.stage, self._camera
        azimuth, elevation = np.radians(camera.azimuth), np.radians(camera.elevation)
        if not camera.follows:
            return self._whole(azimuth, elevation)
        target = np.array([np.interp(time, stage.time, column) for column in self._smooth.T])
        distance = camera.distance or CLOSE * stage.reach
        target[2] -= LOWER * distance * np.cos(elevation)
        lowest = np.arcsin(
            np.clip((stage.floor + 0.1 - target[2]) / distance, -1.0, 1.0)
        )  # keeps the camera above the floor
        return look_at(target, azimuth, max(elevation, lowest), distance, *self._size)

    def _whole(self, azimuth: float, elevation: float) -> View:
        """The view of the whole path from a direction, at the smallest distance at which the path fits."""
        stage = self.stage
        low, high = stage.path.min(axis=0) - stage.reach, stage.path.max(axis=0) + stage.reach
        target = (low + high) / 2.0
        view = look_at(target, azimuth, elevation, 1.0, *self._size)
        back = view.eye - target
        axes = np.array([np.cross(view.up, back), view.up, -back])
        across, up, ahead = np.moveaxis((stage.path - target) @ axes.T, 1, 0)
        half = FILLED * np.array(self._size) / 2.0 / view.focal
        needed = [(np.abs(across) + stage.reach) / half[0] - ahead, (np.abs(up) + stage.reach) / half[1] - ahead]
        distance = float(np.max(needed))
        return look_at(target, azimuth, elevation, distance, *self._size)

    def picture(self, time: float, note: str = "") -> Image.Image:
        """The picture at a time [s]; `note` is written after the time."""
        view = self.view(time)
        distance = view.distance
        cell = 1.0 if distance < 30.0 else 10.0 ** np.floor(np.log10(distance / 3.0))
        image = self._studio.picture(time, view, cell)
        push = float(np.linalg.norm(self.stage.push(time)))
        notes = [self.stage.name, f"{time:.2f} s{note}", f"grid {cell:g} m"]
        notes += (
            [f"push {push:.1f} N" if push >= 1.0 else f"push {push:.2g} N"] if self.stage.is_push_shown(push) else []
        )
        height = max(10, self._size[1] // 40)
        place = height, self._size[1] - 2 * height
        ImageDraw.Draw(image).text(place, "     ".join(notes), fill=INK, font=_font(height))
        return image


@lru_cache(maxsize=4)
def _font(height: int) -> ImageFont.FreeTypeFont:
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts/ttf/DejaVuSans.ttf"), height)


def look_at(target: Array, azimuth: float, elevation: float, distance: float, width: int, height: int) -> View:
    """The view of a target (3) [m] from a direction (azimuth, elevation [rad]) at a distance [m]."""
    c, s = np.cos(elevation), np.sin(elevation)
    back = np.array([c * np.cos(azimuth), c * np.sin(azimuth), s])
    up = np.cross(back, [-np.sin(azimuth), np.cos(azimuth), 0.0])
    focal = min(height, 0.75 * width) / 2.0 / np.tan(ANGLE / 2.0)
    return View(target + distance * back, target, up, float(focal), distance)


def _smoothed(time: Array, path: Array) -> Array:
    """A path (T, 3), smoothed by a running mean that leaves its ends: the target of a following camera."""
    if len(time) < 3:
        return path
    step = float(np.median(np.diff(time)))
    width = 1 + 2 * min((len(time) - 1) // 2, round(FOLLOWING / max(step, 1e-9) / 2.0))  # odd: it has a middle
    padded = np.pad(path, ((width // 2, width // 2), (0, 0)), mode="reflect", reflect_type="odd")
    sums = np.vstack([np.zeros(3), padded.cumsum(axis=0)])
    return (sums[width:] - sums[:-width]) / width


def picture(flight: Flight, shot: Shot = SHOT) -> Image.Image:
    """A picture of a flight at one time.

    Raises:
        InputError: the flight has no sample that can be drawn, or not at that time.
    """
    film = Film(flight, shot.camera, shot.size or SIZES[".png"])
    return film.picture(
        film.stage.strongest_push_time if shot.time is None else film.stage.checked_time("time", shot.time)
    )


class Animation:
    """The pictures of an animation of a flight, drawn as they are iterated over.

    Args:
        flight: to draw; it may have diverged.
        shot: times, size and camera.
        kind: `.gif` or `.mp4`.

    Raises:
        InputError: the flight has no sample that can be drawn, or not within these times; the size or the rate do not
            suit the kind, or an MP4 cannot be written here.
    """

    def __init__(self, flight: Flight, shot: Shot = SHOT, kind: str = ".gif") -> None:
        self.kind, self.size = kind, shot.size or SIZES[kind]
        self._again = partial(Animation, flight, shot, kind)
        if kind == ".mp4":
            check_size(self.size)
            ffmpeg()
        self.film = Film(flight, shot.camera, self.size)
        stage = self.film.stage
        start = float(stage.time[0]) if shot.start is None else stage.checked_time("from", shot.start)
        end = float(stage.time[-1]) if shot.end is None else stage.checked_time("to", shot.end)
        if end < start:
            raise InputError(f"an animation from {start:g} s to {end:g} s has its end before its start")
        speed = max(1.0, float(np.ceil((end - start) / MAX_TIME))) if shot.speed is None else shot.speed
        if not (1.0 <= shot.fps <= 50.0 and 0.001 <= speed <= 1000.0):
            raise InputError(f"fps {shot.fps:g} must be from 1 to 50, and speed {speed:g} from 0.001 to 1000")
        self.interval = 1.0 / shot.fps if kind == ".mp4" else round(100.0 / shot.fps) / 100.0  # as a GIF counts
        step = speed * self.interval
        count = 1 + int((end - start) / step + 1e-9)
        if count > COUNT:
            raise InputError(f"{count} pictures are more than the {COUNT} of one animation: raise speed, or lower fps")
        self.times = start + np.arange(count) * step
        self.note = "" if speed == 1.0 else f" (× {speed:g})"

    def __len__(self) -> int:
        return len(self.times)

    def __iter__(self) -> Iterator[Image.Image]:
        return drawn_by_two(self, self._again)

    def picture(self, index: int) -> Image.Image:
        """The picture of a number."""
        return self.film.picture(float(self.times[index]), self.note)

    def palette(self) -> Image.Image:
        """A common palette of all pictures; palettes of their own would make colours flicker."""
        strongest = np.argmax([np.linalg.norm(self.film.stage.push(float(time))) for time in self.times])
        few = {0, len(self) // 2, len(self) - 1, int(strongest)}
        images = np.concatenate([np.asarray(self.picture(k)) for k in sorted(few)])
        colors = list[int]()
        for method, count in PALETTE:
            colors += Image.fromarray(images).quantize(count, method=method).getpalette()[: 3 * count]  # type: ignore
        palette = Image.new("P", (1, 1))
        palette.putpalette(colors)
        return palette

    def save(self, path: Path, progress: Progress | None) -> None:
        """Write the animation.

        Raises:
            InputError: ffmpeg fails.
        """

        def drawn() -> Iterator[Image.Image]:
            for count, image in enumerate(self, 1):
                yield image
                if progress:
                    progress(count, len(self))

        if self.kind == ".mp4":
            write_mp4(drawn(), self.size, self.interval, path)
            return
        palette = self.palette()
        pictures = (image.quantize(palette=palette, dither=Image.Dither.NONE) for image in drawn())
        look: dict[str, Any] = {"duration": round(1000.0 * self.interval), "loop": 0}
        next(pictures).save(path, format="GIF", save_all=True, append_images=pictures, **look)


def render(flight: Flight, out: str | os.PathLike[str], shot: Shot = SHOT, progress: Progress | None = None) -> Path:
    """Write a picture (.png) or an animation (.gif, .mp4) of a flight atomically.

    Args:
        flight: to draw; it may have diverged.
        out: path of the file.
        shot: times, size and camera.
        progress: called after each picture of an animation with (pictures drawn, total number of pictures).

    Returns:
        The path.

    Raises:
        InputError: the file name has another ending, the flight has no sample that can be drawn, or ffmpeg is missing
            for an MP4.
    """
    path = Path(out)
    kind = path.suffix.lower()
    if kind not in SIZES:
        raise InputError(f"{path}: the name must end in .png (picture), .gif or .mp4 (animation)")
    drawn = picture(flight, shot) if kind == ".png" else Animation(flight, shot, kind)
    with atomic_write(path) as partial:
        if isinstance(drawn, Animation):
            drawn.save(partial, progress)
        else:
            drawn.save(partial, format="PNG")
    return path


def size_of(text: str | None) -> tuple[int, int] | None:
    """Width and height in pixels from WxH; None of None.

    Raises:
        InputError: the text has another form.
    """
    if text is None:
        return None
    if not re.fullmatch(r"\d{1,5}x\d{1,5}", text):
        raise InputError(f"--size {text}: must be WxH in pixels, such as 1280x720")
    width, height = map(int, text.split("x"))
    return width, height


def check_options(path: Path, given: list[str]) -> None:
    """Reject options that do not fit the kind of file, and kinds that cannot be drawn here, before any flight.

    Raises:
        InputError: an option does not fit the kind of file, the kind is unknown, or nothing here can draw it.
    """
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
