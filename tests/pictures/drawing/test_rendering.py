"""Pictures show a flight where it is: projection, shadow, grid, and the files that come of it."""

import dataclasses
import re
import sys

import numpy as np
import pytest
from click.testing import CliRunner
from patience import completed
from PIL import Image

import tandemlift as tl
from tandemlift.apps.cli.export import render as command
from tandemlift.engines.models.visuals import SUN, camera_of
from tandemlift.pictures.drawing import studio
from tandemlift.pictures.drawing.film import Animation, Film, Shot, _smoothed, look_at, picture, render
from tandemlift.pictures.drawing.ground import HAZE, grid, rgb, shadow_on
from tandemlift.pictures.drawing.stage import FlightStage

TINY = (96, 54)


@pytest.fixture(scope="module")
def flight():
    changes = {"mission.duration": 6.0, "pushes.0.time": 3.0}
    return tl.fly(tl.load_mission("one-push", changes))


def reddish(image):
    """Whether pixels are clearly red, and not orange as the front of a quadrotor is."""
    red, green, blue = np.moveaxis(image.astype(int), -1, 0)
    return (red - np.maximum(green, blue) > 40) & (green - blue < 40)


def seen(view, size, point):
    """The column and row of a point as a pinhole camera sees it."""
    ahead = view.target - view.eye
    ahead /= np.linalg.norm(ahead)
    away = point - view.eye
    right = np.cross(ahead, view.up)
    return np.array(size) / 2.0 + view.focal * np.array([away @ right, -(away @ view.up)]) / (away @ ahead)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["follow", "side", "-120,12.5,6"])
def test_the_arrow_of_a_push_appears_where_a_pinhole_camera_sees_it(flight, name):
    size = (480, 270)
    film = Film(flight, camera_of(name), size)
    bare = Film(
        dataclasses.replace(flight, channels=flight.channels | {"push_force": 0.0 * flight["push_force"]}),
        camera_of(name),
        size,
    )
    changed = (
        np.abs(np.asarray(film.picture(3.0)).astype(int)[:250] - np.asarray(bare.picture(3.0)).astype(int)[:250]).max(
            axis=-1
        )
        > 40
    )
    rows, columns = np.nonzero(changed)
    found = np.array([[columns.min(), rows.min()], [columns.max(), rows.max()]])
    ends = np.array([seen(film.view(3.0), size, point) for point in film.stage.arrow(3.0)])
    np.testing.assert_allclose(found + 0.5, [ends.min(axis=0), ends.max(axis=0)], atol=6.0)  # an arrow is wide


@pytest.mark.parametrize("count", [3, 4, 40, 400])
def test_a_following_camera_keeps_a_falling_vehicle_in_its_middle(count):
    time = np.linspace(0.0, 3.0, count)
    fall = np.column_stack([0.5 * time, 0.0 * time, -4.905 * time**2])
    off = np.abs(_smoothed(time, fall) - fall).max(axis=1)
    assert max(off[0], off[-1]) < 1e-12
    assert off.max() < (0.2 if count > 4 else 6.0)  # a parabola's mean over 0.6 s: g · 0.6² / 24 = 0.15 m


def test_a_shadow_lies_where_the_suns_rays_meet_the_floor():
    point = np.array([1.0, -2.0, 3.0])
    shadow = (shadow_on(0.5) @ [*point, 1.0])[:3]
    np.testing.assert_allclose(shadow, point - SUN / SUN[2] * 2.5, atol=1e-12)


def test_the_lines_of_the_grid_stand_at_the_multiples_of_its_cells_and_fade_with_distance():
    view = look_at(np.array([3.3, -4.7, 1.0]), 0.3, 0.4, 5.0, 640, 360)
    points, cells, colors = grid(view, 2.0, 0.0)
    lines = points[cells.reshape(-1, 3)[:, 1:]]
    alike = np.abs(np.diff(lines, axis=1)[:, 0, :2]) < 1e-12  # each line keeps its x or its y
    assert (alike.sum(axis=1) == 1).all()
    kept = lines[:, 0, :2][alike]
    np.testing.assert_allclose(kept / 2.0, np.round(kept / 2.0), atol=1e-12)
    away, dark = np.linalg.norm(points - view.eye, axis=1), rgb(HAZE).sum() - colors.sum(axis=1)
    assert dark[away < 6.0].min() > dark[away > 40.0].max()


def test_the_arrow_of_a_push_starts_on_the_line_along_which_it_acts(flight):
    point, k = np.array([0.0, 0.7, 0.1]), int(np.argmin(np.abs(flight.time - 3.0)))
    moment = {"push_moment": np.cross(point, flight["push_force"])}  # level within milliradians
    stage = FlightStage(dataclasses.replace(flight, channels=flight.channels | moment))
    start, tip = stage.arrow(3.0)
    force = flight["push_force"][k] / np.linalg.norm(flight["push_force"][k])
    np.testing.assert_allclose(np.cross(start - flight["position"][k] - point, force), 0.0, atol=0.01)
    np.testing.assert_allclose(tip - start, 0.9 * force, atol=0.01)
    assert stage.arrow(0.5) is None
    noise = FlightStage(
        dataclasses.replace(flight, channels=flight.channels | {"push_force": 1e-9 * flight["push_force"]})
    )
    assert noise.arrow(3.0) is None
    assert noise.strongest_push_time == flight.time[-1]


def test_the_floor_touches_the_lowest_foot_of_the_flight_or_is_the_missions(flight):
    assert FlightStage(flight).floor == pytest.approx(flight["position"][:, 2].min() + 0.0107 - 0.18, abs=0.02)
    ground = {"ground": {"model": "floor", "height": -0.7}}
    assert FlightStage(dataclasses.replace(flight, mission=flight.mission | ground)).floor == -0.7


@pytest.mark.thorough
def test_a_picture_is_the_same_to_the_last_byte_and_shows_the_push(flight, tmp_path):
    one, two = (render(flight, tmp_path / name, Shot(size=TINY)) for name in ("a.png", "b.PNG"))
    assert one.read_bytes() == two.read_bytes()
    with Image.open(one) as image:
        assert image.size == TINY
        assert reddish(np.asarray(image)).sum() > 5  # by default at the strongest push
    assert not reddish(np.asarray(picture(flight, Shot(time=0.5, size=TINY, camera=camera_of("side"))))).any()


@pytest.mark.thorough
def test_walls_are_seen_through_and_blended_in_the_order_that_depth_peeling_finds_for_each_pixel(flight):
    walls = {"walls": [{"start": [-3.0, y], "end": [3.0, y], "top": 2.0} for y in (-1.6, 1.6)]}
    film = Film(dataclasses.replace(flight, mission=flight.mission | walls), camera_of("side"), (320, 180))
    drawn = np.asarray(film.picture(3.0)).astype(int)
    free = np.asarray(picture(flight, Shot(time=3.0, size=(320, 180), camera=camera_of("side")))).astype(int)
    assert (np.abs(drawn - free).max(axis=-1) > 8).mean() > 0.3
    assert reddish(drawn).any()  # the arrow behind the wall
    renderer = film._studio._plotter.renderer
    renderer.UseDepthPeelingOn()
    renderer.SetMaximumNumberOfPeels(40)
    renderer.SetOcclusionRatio(0.0)  # as many layers as there are
    peeled = np.asarray(film.picture(3.0)).astype(int)
    assert (np.abs(drawn - peeled).max(axis=-1) > 2).sum() < 20  # at edges; an average of all layers: 137 pixels


@pytest.mark.thorough
def test_every_camera_shows_the_vehicle(flight):
    for name in ("overview", "front", "top", "30,40"):
        image = np.asarray(picture(flight, Shot(size=TINY, camera=camera_of(name)))).astype(int)
        assert (image.min(axis=-1) < 90).sum() > 10, name  # its dark parts


@pytest.mark.thorough
def test_an_animation_lasts_as_long_as_it_says(flight, tmp_path):
    done = []
    shot = Shot(start=2.0, end=4.0, fps=10.0, speed=2.0, size=TINY)
    path = render(flight, tmp_path / "push.gif", shot, lambda k, n: done.append((k, n)))
    with Image.open(path) as film:
        assert (film.n_frames, film.size, film.info["duration"], film.info["loop"]) == (11, TINY, 100, 0)
        first = np.asarray(film.convert("RGB"))
        film.seek(5)
        assert reddish(np.asarray(film.convert("RGB"))).sum() > reddish(first).sum()
    assert done == [(k, 11) for k in range(1, 12)]
    assert len(Animation(flight, Shot(fps=30.0, speed=1.0))) == 201  # of 30 ms, as a GIF counts
    assert Animation(dataclasses.replace(flight, time=flight.time * 10.0)).note == " (× 3)"


def test_a_flight_that_diverged_is_drawn_as_far_as_it_went(flight):
    channels = {name: values.copy() for name, values in flight.channels.items()}
    channels["position"][-3:], channels["attitude"][-2:] = np.nan, np.inf
    stage = FlightStage(dataclasses.replace(flight, channels=channels))
    assert stage.time[-1] == flight.time[-4]
    picture(dataclasses.replace(flight, channels=channels), Shot(size=TINY, time=float(stage.time[-1])))


@pytest.mark.parametrize(
    ("shot", "name", "says"),
    [
        (Shot(time=float("nan")), "a.png", "time nan s is outside of the flight, 0 s to 6 s"),
        (Shot(start=3.0, end=2.0), "a.gif", "its end before its start"),
        (Shot(speed=0.002), "a.gif", "more than the 3000 of one animation"),
        (Shot(fps=float("nan")), "a.gif", "fps nan must be from 1 to 50"),
        (Shot(speed=0.0), "a.gif", "speed 0 from 0.001 to 1000"),
        (Shot(size=(3, 3)), "a.png", "size 3x3 must be at least 16x16"),
        (Shot(), "a.jpg", r"the name must end in \.png \(picture\), \.gif or \.mp4 \(animation\)"),
    ],
)
def test_what_cannot_be_drawn_is_refused_with_the_reason_and_no_file(flight, tmp_path, shot, name, says):
    with pytest.raises(tl.InputError, match=says):
        render(flight, tmp_path / name, shot)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("text", ["folow", "1,2,3,4", "1,x", "0,90", "nan,20", "0,20,0"])
def test_a_camera_that_is_none_is_refused_with_what_there_is(text):
    with pytest.raises(tl.InputError, match=r"camera '.*AZIMUTH,ELEVATION\[,DISTANCE\]"):
        camera_of(text)


def run(*args):
    """The result of `tandemlift render`; bad input is raised, as the command line's entry tells it."""
    return CliRunner().invoke(command, args, catch_exceptions=False)


@pytest.mark.thorough
def test_the_command_draws_saved_flights_and_missions(flight, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    flight.save("results/flight.npz")
    assert run("results", "--size", "96x54").output == f"one-push: {'results/picture.png'}\n"
    run("results/flight.npz", "--out", "a.gif", "--from", "1", "--to", "2", "--fps", "5", "--size", "96x54")
    with Image.open("a.gif") as film:
        assert film.n_frames == 6
    run("hover", "--set", "mission.duration=1", "--size", "96x54")
    assert sorted(re.sub(r"\\", "/", str(p.relative_to(tmp_path))) for p in tmp_path.rglob("*.png")) == [
        "out/hover/picture.png",
        "results/picture.png",
    ]
    for option in (("--set", "mission.duration=1"), ("--engine", "mujoco")):
        with pytest.raises(
            tl.InputError, match=r"^--set, --engine: results.flight\.npz is a saved flight, which cannot"
        ):
            run("results", *option)


@pytest.mark.parametrize(
    ("args", "says"),
    [
        (["--out", "a.gif", "--time", "1"], "--time is for a picture, --out FILE.png"),
        (
            ["--out", "a.png", "--from", "1", "--fps", "5"],
            "--from, --fps are for an animation, --out FILE.gif or FILE.mp4",
        ),
        (["--size", "1280"], "--size 1280: must be WxH in pixels, such as 1280x720"),
        (["--out", "a.bmp"], r"--out a.bmp: the name must end in .png \(picture\), .gif or .mp4 \(animation\)"),
    ],
)
def test_options_that_mean_nothing_are_refused_before_anything_flies(args, says):
    with pytest.raises(tl.InputError, match=f"^{says}$"):
        run("no-such-mission", *args)


def test_a_missing_package_and_a_system_that_cannot_draw_are_named(flight, tmp_path, monkeypatch):
    studio.pyvista.cache_clear()
    monkeypatch.setattr(studio, "WINDOWS", {"libnowhere.so.1": "vtkEGLRenderWindow"})
    with pytest.raises(tl.InputError, match="needs EGL or OSMesa: apt-get install libegl1 libgl1-mesa-dri"):
        render(flight, tmp_path / "a.png")
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(tl.InputError, match=r"drawing a flight needs pyvista: pip install 'tandemlift\[video\]'"):
        render(flight, tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []
    studio.pyvista.cache_clear()


def test_nothing_of_graphics_is_imported_before_something_is_drawn():
    graphics = ("mujoco", "vtkmodules", "tkinter")
    code = f"import sys, tandemlift.pictures.drawing; print([m for m in {graphics} if m in sys.modules])"
    assert completed([sys.executable, "-c", code], capture_output=True, text=True).stdout == "[]\n"
