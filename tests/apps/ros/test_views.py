"""The four views of the paper's Figure 9: when they are taken, from where, and what is drawn of them."""

import io
from xml.etree import ElementTree

import matplotlib.image
import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.apps.cli.main import main
from tandemlift.apps.ros.gazebo_cameras import views_from
from tandemlift.core.phases import PHASE_NAMES
from tandemlift.engines.models.sdf import world
from tandemlift.engines.models.sdf_elements import FixedCamera, add_cameras
from tandemlift.missions import tables_of
from tandemlift.pictures.report.flight_report import write_flight_files

STANDS, FLIES, LANDS = 5.0, 25.0, 30.0  # s


@pytest.fixture(scope="module")
def flight():
    """Stands, then 20 m in 20 s first along x and then along y, then lands and stands."""
    time = np.arange(0.0, 40.0, 0.01)
    way = np.clip(time - STANDS, 0.0, FLIES - STANDS)
    up = np.clip(np.minimum(time - STANDS, LANDS - time), 0.0, 1.0)
    phase = np.select(
        [time < STANDS, time < FLIES, time < LANDS], [PHASE_NAMES.index(n) for n in ("idle", "guided", "land")]
    )
    channels = {
        "position": np.column_stack([np.minimum(way, 15.0), np.maximum(way - 15.0, 0.0), up]),
        "phase": phase.astype(float),
        "contact_force": np.column_stack([0.0 * time, 0.0 * time, np.where(up > 0.0, 0.0, 34.0)]),
    }
    return tl.Flight(time, channels, tables_of(tl.load_mission("zigzag")), {})


def test_views_are_of_standing_half_the_way_its_end_and_the_landed_vehicle(flight):
    shots = views_from(flight)
    assert [s.title for s in shots] == ["standing", "on its way", "at the end of its way", "landed"]
    assert [s.time for s in shots] == pytest.approx([0.0, 15.0, FLIES, 38.99], abs=0.02)
    assert np.array([s.camera.target for s in shots[1:]]) == pytest.approx(
        np.array([[10, 0, 1], [15, 5, 1], [15, 5, 0]]), abs=0.02
    )
    assert len({s.camera.name for s in shots}) == 4


def test_cameras_stand_over_the_vehicle_and_look_along_the_way_or_back(flight):
    start, way, end, landed = (s.camera for s in views_from(flight))
    for eye in (start, way, end, landed):
        assert eye.position[2] > eye.target[2] + 2.0  # m
        assert 5.0 < np.linalg.norm(eye.position - eye.target) < 12.0
    for eye in (start, way):  # behind it
        assert eye.position[0] < eye.target[0] - 3.0
    for eye in (end, landed):  # before it, on the side that it flew to last
        assert eye.position[1] > eye.target[1] + 3.0


def test_a_flight_that_stays_where_it_is_is_seen_too():
    time = np.arange(0.0, 4.0, 0.01)
    still = tl.Flight(time, {"position": np.zeros((len(time), 3))}, tables_of(tl.load_mission("hover")), {})
    shots = views_from(still)
    assert [shots[0].title, shots[-1].title] == ["at the start", "at the end"]
    assert np.isfinite([s.camera.position for s in shots]).all()


def test_a_camera_of_a_world_looks_at_its_target():
    eye = FixedCamera("view", np.array([3.0, -4.0, 5.0]), np.array([-1.0, 2.0, 0.5]))
    text = add_cameras(world(tl.load_mission("zigzag")), [eye], 0.5)
    model = ElementTree.fromstring(text.encode()).find(".//model[@name='view']")
    *position, roll, pitch, yaw = map(float, model.findtext("pose").split())
    ahead = Rotation.from_euler("xyz", [roll, pitch, yaw]).apply([1.0, 0.0, 0.0])  # SDF: x of a camera is ahead
    wanted = eye.target - eye.position
    assert position == pytest.approx(eye.position)
    assert ahead == pytest.approx(wanted / np.linalg.norm(wanted), abs=1e-5)
    assert float(model.findtext(".//update_rate")) == 2.0


def picture(color):
    file = io.BytesIO()
    Image.new("RGB", (320, 180), color).save(file, "jpeg")
    return file.getvalue()


def test_pictures_are_drawn_side_by_side_and_come_first_in_the_report(flight, tmp_path):
    colors = ("red", "lime", "blue", "yellow")
    whole = tl.fly(tl.load_mission("paper", {"mission.duration": 1.0}))
    write_flight_files(whole, tmp_path, photographs=[(f"view {c}", picture(c)) for c in colors])
    path = tmp_path / "figures" / "views.png"
    drawn = matplotlib.image.imread(path)[:, :, :3]
    high, wide = drawn.shape[:2]
    middles = [drawn[int(y * high), int(x * wide)] for y in (0.3, 0.8) for x in (0.25, 0.75)]
    assert np.array(middles) == pytest.approx(np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0]]), abs=0.03)
    text = (tmp_path / "report.html").read_text("utf-8")
    assert text.index("Figure 1. Photographs") < text.index("Figure 2. Reference")


@pytest.mark.parametrize("option", ["--fast", "--pictures"])
def test_a_flight_by_hand_is_neither_fast_nor_photographed(option, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["tandemlift", "gazebo", "hover", "--by-hand", option])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert option in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_without_gazebo_the_command_says_where_to_get_it_and_writes_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("TANDEMLIFT_GAZEBO_ROOT", raising=False)
    monkeypatch.setattr("sys.argv", ["tandemlift", "gazebo", "hover", "--no-window"])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert "tools/gazebo-root" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
