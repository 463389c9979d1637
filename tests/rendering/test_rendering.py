"""Pictures show what is there, where it is: projection, hiding, shadow, grid, and the files that come of it."""

import dataclasses
import re
import sys

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from patience import completed
from PIL import Image

import tandemlift as tl
from tandemlift.cli.render import render as command
from tandemlift.rendering import Animation, Shot, camera_of, picture, render, studio
from tandemlift.rendering.camera import ANGLE, look_at
from tandemlift.rendering.ground import line_coverage
from tandemlift.rendering.light import SUN, Shadow
from tandemlift.rendering.mesh import EMPTY, box, cylinder, merged, panel, sphere, torus
from tandemlift.rendering.stage import FlightStage
from tandemlift.rendering.studio import Pane, Scene, SceneLine, render_scene

TINY = (96, 54)
RED, BLUE = "#ff0000", "#0000ff"


@pytest.fixture(scope="module")
def flight():
    changes = {"mission.duration": 6.0, "pushes.0.time": 3.0}
    return tl.fly(tl.load_mission("one-push", changes))


def scene(solid=EMPTY, panes=(), lines=()):
    """A scene far above its floor."""
    return Scene(solid, list(lines), list(panes), -50.0, 1.0)


SHADED = sphere([0.0, 0.0, -40.0], 0.1, RED)  # out of sight; a shadow needs something that throws it
VIEW = look_at([0.0, 0.0, 0.0], 0.0, 0.0, 10.0, 320, 180)  # from +x, y to the right, z up
FOCAL = 90.0 / np.tan(ANGLE / 2.0)


def reddish(image):
    """Whether pixels are clearly red."""
    light = image.astype(int)
    return light[..., 0] - light[..., 1:].max(axis=-1) > 40


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (3.0, 1.2, 0.5), (-6.0, -3.0, -2.0)])
def test_a_ball_appears_where_a_pinhole_camera_sees_it_and_as_large(place):
    x, y, z = place
    image = render_scene(scene(merged([sphere(place, 0.4, RED), SHADED])), VIEW, 10.0, 3)
    rows, columns = np.nonzero(reddish(image))
    distance = 10.0 - x
    assert columns.mean() + 0.5 == pytest.approx(160.0 + FOCAL * y / distance, abs=0.5)
    assert rows.mean() + 0.5 == pytest.approx(90.0 - FOCAL * z / distance, abs=0.5)
    assert len(rows) == pytest.approx(np.pi * (FOCAL * 0.4 / distance) ** 2, rel=0.1)


def test_what_is_nearer_hides_what_is_behind_it_whichever_is_drawn_first():
    near, far = sphere([2.0, 0.0, 0.0], 0.5, BLUE), sphere([-2.0, 0.0, 0.0], 0.5, RED)
    for order in ([near, far], [far, near]):
        assert not reddish(render_scene(scene(merged([*order, SHADED])), VIEW, 10.0, 1)).any()


def test_what_is_behind_the_eye_is_not_drawn():
    behind = merged([sphere([14.0, 0.0, 0.0], 0.5, RED), SHADED])
    assert not reddish(render_scene(scene(behind), VIEW, 10.0, 1)).any()


def test_a_pane_mixes_with_what_is_behind_it_in_proportion_to_its_opacity():
    bright = studio.Mesh(*panel([-2.0, -2.0, -2.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0], "#ffffff"))
    bright = bright._replace(normals=np.zeros_like(bright.normals))  # shines by itself
    pane = panel([2.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], "#000000")
    image = render_scene(scene(merged([bright, SHADED]), [Pane(pane, 0.25)]), VIEW, 10.0, 1)
    half_up = 255.0 * (1.055 * 0.75 ** (1 / 2.4) - 0.055)  # 0.75 of the light as sRGB
    np.testing.assert_allclose(image[90, 160], half_up, atol=1.0)


def test_a_line_keeps_its_width_in_pixels_at_any_distance():
    width = 8.0
    for x in (0.0, -30.0):
        points = np.array([[x, -20.0, 0.0], [x, 20.0, 0.0]])
        line = SceneLine(points, width, np.tile([1.0, 0.0, 0.0], (2, 1)))
        image = render_scene(scene(SHADED, lines=[line]), VIEW, 10.0, 4)
        assert reddish(image)[:, 160].sum() == pytest.approx(width * 180.0 / 720.0, abs=1.0)


def test_a_large_picture_is_the_same_in_strips(monkeypatch):
    parts = scene(merged([torus([0.0, 0.0, 0.0], 2.0, 0.1, RED), box([1.0, 1.0, 0.5], [1.0, 1.0, 1.0], BLUE)]))
    whole = render_scene(parts, VIEW, 10.0, 2)
    monkeypatch.setattr(studio, "AT_ONCE", 320 * 4 * 7)
    np.testing.assert_array_equal(render_scene(parts, VIEW, 10.0, 2), whole)


def volume(mesh):
    """By the ending theorem."""
    a, b, c = np.moveaxis(mesh.corners, 1, 0)
    return abs((a * np.cross(b, c)).sum() / 6.0)


@pytest.mark.parametrize(
    ("mesh", "expected", "error"),
    [
        (sphere([1.0, 2.0, 3.0], 0.5, RED), 4.0 / 3.0 * np.pi * 0.5**3, 0.06),
        (cylinder([0.0, 1.0, 0.0], [2.0, 1.0, 1.0], 0.3, RED, sides=60), np.pi * 0.3**2 * np.sqrt(5.0), 0.01),
        (cylinder([0.0, 0.0, 0.0], [0.0, 2.0, 0.0], 0.3, RED, 0.0, sides=60), np.pi * 0.3**2 * 2.0 / 3.0, 0.01),
        (torus([0.0, 0.0, 0.0], 1.0, 0.1, RED), 2.0 * np.pi**2 * 0.1**2, 0.12),
        (box([1.0, 0.0, 0.0], [1.0, 2.0, 3.0], RED), 6.0, 1e-12),
    ],
    ids=["ball", "rod", "cone", "ring", "box"],
)
def test_shapes_are_closed_and_their_normals_point_outward(mesh, expected, error):
    assert volume(mesh) == pytest.approx(expected, rel=error)
    a, b, c = np.moveaxis(mesh.corners, 1, 0)
    areas = np.cross(b - a, c - a)
    np.testing.assert_allclose(areas.sum(axis=0), 0.0, atol=1e-12)  # of a closed surface
    flux = (mesh.corners * mesh.normals).sum(axis=-1).mean(axis=1) * np.linalg.norm(areas, axis=1) / 6.0
    assert flux.sum() == pytest.approx(expected, rel=0.1)


def test_a_shadow_lies_where_the_suns_rays_through_a_body_meet_the_floor():
    shadow = Shadow(sphere([1.0, -2.0, 3.0], 0.2, RED).corners, 0.5)
    rows, columns = np.indices(shadow.shade.shape)
    weight = shadow.shade / shadow.shade.sum()
    center = np.array([(columns * weight).sum(), (rows * weight).sum()]) + 0.5
    expected = np.array([1.0, -2.0]) - SUN[:2] / SUN[2] * 2.5
    np.testing.assert_allclose(shadow.low + shadow.texel * center, expected, atol=0.01)
    below = np.array([[1.0, -2.0, 3.0]]) - 1.5 * SUN
    beside = below + np.array([0.5, 0.0, 0.0])
    np.testing.assert_array_equal(shadow.shade_on(np.concatenate([below, beside])), [1.0, 0.0])


@given(st.floats(-5.0, 5.0), st.floats(0.01, 7.0), st.floats(0.01, 0.3))
def test_lines_cover_the_share_of_a_pixel_that_samples_find(start, blur, width):
    x = start + blur * (np.arange(20000) + 0.5) / 20000
    found = np.mean(x % 1.0 < width)
    assert line_coverage(start, blur, 1.0, width) == pytest.approx(found, abs=2e-3)


def test_the_arrow_of_a_push_starts_on_the_line_along_which_it_acts(flight):
    point, k = np.array([0.0, 0.7, 0.1]), int(np.argmin(np.abs(flight.time - 3.0)))
    moment = {"push_moment": np.cross(point, flight["push_force"])}  # level within milliradians
    stage = FlightStage(dataclasses.replace(flight, channels=flight.channels | moment))
    solid, without = stage.scene(3.0, 0.01).solid, stage.scene(0.5, 0.01).solid
    arrow = solid.corners[len(without.corners) :].reshape(-1, 3)  # what there is only while the push acts
    acts = flight["position"][k] + point
    force = flight["push_force"][k] / np.linalg.norm(flight["push_force"][k])
    np.testing.assert_allclose(np.linalg.norm(np.cross(arrow - acts, force), axis=1).min(), 0.0, atol=0.01)
    assert np.ptp(arrow @ force) == pytest.approx(0.9, abs=0.01)


def test_the_floor_touches_the_lowest_foot_of_the_flight_or_is_the_missions(flight):
    assert FlightStage(flight).floor == pytest.approx(flight["position"][:, 2].min() + 0.0107 - 0.18, abs=0.02)
    ground = {"ground": {"model": "floor", "height": -0.7}}
    assert FlightStage(dataclasses.replace(flight, mission=flight.mission | ground)).floor == -0.7


def test_a_picture_is_the_same_to_the_last_byte_and_shows_the_push(flight, tmp_path):
    one, two = (render(flight, tmp_path / name, Shot(size=TINY)) for name in ("a.png", "b.PNG"))
    assert one.read_bytes() == two.read_bytes()
    with Image.open(one) as image:
        assert image.size == TINY
        assert reddish(np.asarray(image)).sum() > 5  # by default at the strongest push
    assert not reddish(np.asarray(picture(flight, Shot(time=0.5, size=TINY, camera=camera_of("side"))))).any()


def test_walls_are_seen_and_seen_through(flight):
    walls = {"walls": [{"start": [-3.0, -1.6], "end": [3.0, -1.6], "top": 2.0}]}
    shot = Shot(size=TINY, camera=camera_of("side"))
    free = np.asarray(picture(flight, shot)).astype(int)
    walled = np.asarray(picture(dataclasses.replace(flight, mission=flight.mission | walls), shot)).astype(int)
    changed = np.abs(walled - free).max(axis=-1) > 8
    assert changed.mean() > 0.3
    assert reddish(walled).any()  # the arrow behind the wall


@pytest.mark.parametrize("name", ["follow", "overview", "front", "side", "top", "30,40", "-120,12.5,6"])
def test_every_camera_shows_the_vehicle(flight, name):
    image = np.asarray(picture(flight, Shot(size=TINY, camera=camera_of(name)))).astype(int)
    assert (image.min(axis=-1) < 90).sum() > 10  # its dark parts


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
        (Shot(time=7.0), "a.png", r"time 7 s is outside of the flight, 0 s to 6 s"),
        (Shot(time=float("nan")), "a.png", "time nan s is outside"),
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


@pytest.mark.parametrize("text", ["folow", "1", "1,2,3,4", "1,x", "0,90", "0,1", "nan,20", "0,20,0"])
def test_a_camera_that_is_none_is_refused_with_what_there_is(text):
    with pytest.raises(tl.InputError, match=r"camera '.*AZIMUTH,ELEVATION\[,DISTANCE\]"):
        camera_of(text)


def run(*args):
    """The result of `tandemlift render`; bad input is raised, as the command line's entry tells it."""
    return CliRunner().invoke(command, args, catch_exceptions=False)


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


def test_nothing_of_graphics_is_needed():
    code = "import sys, tandemlift.rendering; print([m for m in ('mujoco', 'OpenGL', 'tkinter') if m in sys.modules])"
    assert completed([sys.executable, "-c", code], capture_output=True, text=True).stdout == "[]\n"
