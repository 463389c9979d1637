"""An MP4 is H.264 that browsers play: read by a decoder that knows nothing of us, picture by picture."""

import re
import subprocess
import sys

import numpy as np
import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.export import render as command
from tandemlift.pictures.drawing import second_studio, video
from tandemlift.pictures.drawing.film import Animation, Shot, render

SIZE = (160, 90)
SHOT = Shot(start=2.0, end=3.0, fps=12.0, size=SIZE)


def has_ffmpeg():
    try:
        return bool(video.ffmpeg())
    except tl.InputError:
        return False


needs_ffmpeg = pytest.mark.skipif(not has_ffmpeg(), reason="ffmpeg is not installed")


@pytest.fixture(scope="module")
def flight():
    return tl.fly(tl.load_mission("one-push", {"mission.duration": 6.0, "pushes.0.time": 3.0}))


@pytest.fixture(scope="module")
def written(flight, tmp_path_factory):
    told = []
    path = render(flight, tmp_path_factory.mktemp("video") / "push.mp4", SHOT, lambda *counts: told.append(counts))
    assert told == [(i, 13) for i in range(1, 14)]
    return path


@pytest.fixture
def nothing_installed(monkeypatch):
    """Neither the program nor the package."""
    monkeypatch.setenv("PATH", "")
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    video.ffmpeg.cache_clear()
    yield
    video.ffmpeg.cache_clear()


def boxes(data, start=0, end=None):
    """The boxes of an MP4 (ISO 14496-12) as (kind, first, last)."""
    end = len(data) if end is None else end
    while start < end:
        size, kind = int.from_bytes(data[start : start + 4], "big"), data[start + 4 : start + 8]
        yield kind.decode("latin-1"), start + 8, start + size
        start += size


@pytest.mark.thorough
@needs_ffmpeg
def test_the_index_stands_first_and_the_video_is_avc_of_its_size(written):
    data = written.read_bytes()
    kinds = [kind for kind, _, _ in boxes(data)]
    assert kinds[0] == "ftyp"
    assert kinds.index("moov") < kinds.index("mdat"), "a page can play it while it loads"
    sample = data.index(b"avc1", data.index(b"stsd"))
    width, height = (int.from_bytes(data[sample + at : sample + at + 2], "big") for at in (28, 30))
    assert (width, height) == SIZE
    assert data.count(b"mp4a") == 0


@pytest.mark.thorough
@needs_ffmpeg
def test_a_decoder_finds_every_picture_at_its_rate_with_its_colours(flight, written):
    said = subprocess.run([video.ffmpeg(), "-i", written, "-hide_banner"], capture_output=True, text=True).stderr
    assert re.search(r"Video: h264 .*yuv420p\(tv, bt709.*160x90.* 12 fps", said)
    decode = [video.ffmpeg(), "-loglevel", "error", "-i", written, "-f", "rawvideo", "-pix_fmt", "rgb24"]
    decode += ["-sws_flags", "accurate_rnd+full_chroma_int+full_chroma_inp", "-"]
    dots = np.frombuffer(subprocess.run(decode, capture_output=True, check=True).stdout, np.uint8)
    shown = dots.reshape(-1, SIZE[1], SIZE[0], 3).astype(float)
    drawn = [np.asarray(picture, float) for picture in Animation(flight, SHOT, ".mp4")]
    assert len(shown) == len(drawn) == 13
    for k in (0, 6, 12):
        assert np.abs(shown[k] - drawn[k]).mean() < 4.0, "of 255"
        assert np.abs(shown[k].mean(axis=(0, 1)) - drawn[k].mean(axis=(0, 1))).max() < 1.5, "no shift of colours"


def test_an_odd_size_is_refused_with_an_even_one(flight, tmp_path):
    with pytest.raises(tl.InputError, match="size 161x91: width and height of an MP4 must be even, such as 162x92"):
        render(flight, tmp_path / "a.mp4", Shot(size=(161, 91)))
    assert list(tmp_path.iterdir()) == []


def test_without_ffmpeg_the_command_is_named_before_anything_flies(nothing_installed, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(tl.InputError, match=r"^an MP4 needs imageio_ffmpeg: pip install 'tandemlift\[video\]'$"):
        CliRunner().invoke(command, ["no-such-mission", "--out", "a.mp4"], catch_exceptions=False)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("script", ["exit 3", "echo no space left >&2; exit 1"])
def test_an_ffmpeg_that_fails_leaves_nothing_and_its_words_are_told(script, flight, tmp_path, monkeypatch):
    program = tmp_path / "bin" / "ffmpeg"
    program.parent.mkdir()
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setattr(video, "ffmpeg", lambda: str(program))
    monkeypatch.setattr("tandemlift.pictures.drawing.film.ffmpeg", video.ffmpeg)
    (tmp_path / "there").mkdir()
    with pytest.raises(tl.InputError, match=r"failed: (exit code 3|no space left)"):
        render(flight, tmp_path / "there" / "a.mp4", SHOT)
    assert list((tmp_path / "there").iterdir()) == []


@pytest.mark.thorough
@pytest.mark.parametrize("dies", [False, True])
def test_a_second_process_draws_the_same_bytes_and_the_first_one_all_if_it_dies(flight, monkeypatch, dies):
    drawn = [image.tobytes() for image in Animation(flight, SHOT)]
    monkeypatch.setattr(second_studio, "MIN_PICTURES", 1)
    monkeypatch.setattr(second_studio.os, "cpu_count", lambda: 2)
    take = second_studio._Shared.take
    if dies:
        monkeypatch.setattr(second_studio.pickle, "dumps", lambda _: b"nothing that can be drawn")
    else:  # the first process takes none
        monkeypatch.setattr(
            second_studio._Shared, "take", lambda s, ahead=None: None if ahead is None else take(s, ahead)
        )
    both, asked = Animation(flight, SHOT), set[int]()
    one = both.picture
    monkeypatch.setattr(both, "picture", lambda index: asked.add(index) or one(index))
    assert [image.tobytes() for image in both] == drawn
    assert asked == (set(range(len(both))) if dies else set())
