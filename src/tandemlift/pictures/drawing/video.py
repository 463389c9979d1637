"""Pictures as a video: H.264 in MP4, which every browser plays, written by the program ffmpeg.

Each picture goes to ffmpeg as it is drawn. (The writer of imageio_ffmpeg does not look at its exit code.) Colours are
those of ITU-R BT.709, with every second sample of colour each way (yuv420p), so width and height are even. The index of
the file stands first: a page can play it while it loads.
"""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import IO

from PIL import Image

from tandemlift.core.errors import InputError, extra

ENCODER = "libx264"
QUALITY = 20  # of x264: a constant rate factor, lower is better
PRESET = "veryfast"  # a third of the default's time, which drawing needs
COLOURS = "bt709"


@cache
def ffmpeg() -> str:
    """The program ffmpeg that the package imageio-ffmpeg brings or finds; IMAGEIO_FFMPEG_EXE names another.

    Raises:
        InputError: the package is not installed, or has no program for this machine.
    """
    with extra("video", "an MP4"):
        import imageio_ffmpeg
    try:
        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except RuntimeError as error:
        raise InputError(f"an MP4 needs ffmpeg: {error}") from None


def check_size(size: tuple[int, int]) -> None:
    """Refuse a size of a video in pixels that is not even.

    Raises:
        InputError: width or height is odd.
    """
    width, height = size
    if width % 2 or height % 2:
        even = f"{width + width % 2}x{height + height % 2}"
        raise InputError(f"size {width}x{height}: width and height of an MP4 must be even, such as {even}")


def write_mp4(pictures: Iterable[Image.Image], size: tuple[int, int], interval: float, path: Path) -> None:
    """Write pictures of one size [pixels] as a video, `interval` [s] apart.

    Raises:
        InputError: ffmpeg is missing or fails, or the size is odd.
    """
    check_size(size)
    command = [ffmpeg(), "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command += ["-s", f"{size[0]}x{size[1]}", "-framerate", f"{1.0 / interval:.6f}", "-i", "-", "-an"]
    command += ["-vf", f"scale=out_color_matrix={COLOURS}:out_range=tv", "-c:v", ENCODER, "-pix_fmt", "yuv420p"]
    for what in ("colorspace", "color_primaries", "color_trc"):
        command += [f"-{what}", COLOURS]
    command += ["-crf", str(QUALITY), "-preset", PRESET, "-movflags", "+faststart", "-f", "mp4", "-y", str(path)]
    with tempfile.TemporaryFile() as said:
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said) as process:
            assert process.stdin is not None
            _send(pictures, process.stdin)
        if process.returncode:
            said.seek(0)
            lines = said.read().decode("utf-8", "replace").strip().splitlines()
            raise InputError(f"{command[0]} failed: {lines[-1] if lines else f'exit code {process.returncode}'}")


def _send(pictures: Iterable[Image.Image], to: IO[bytes]) -> None:
    """Send pictures; ends early if the other side does, whose exit code then says so."""
    try:
        for picture in pictures:
            to.write(picture.tobytes())
        to.close()
    except BrokenPipeError:
        return
