"""Models are written whole or not at all, by Python and by the command; what does not fit is refused."""

import sys
from pathlib import Path

import pytest
from exported import flight_of

import tandemlift as tl
from tandemlift.apps.export.write import export


@pytest.mark.parametrize("ending", ["sdf", "xml"])
def test_the_same_mission_gives_the_same_bytes_and_so_does_its_flight(ending, mujoco, tmp_path):
    flight = flight_of("iris")
    first, second = export(tl.load_mission("iris"), tmp_path / f"a.{ending}"), export(flight, tmp_path / f"b.{ending}")
    assert first.read_bytes() == second.read_bytes()


def check_refused(what, path, **options):
    """Why something is not exported; what was there stays, and nothing is added."""
    before = {p: p.is_file() and p.read_bytes() for p in path.parent.iterdir()}
    with pytest.raises(tl.InputError) as caught:
        export(what, path, **options)
    assert {p: p.is_file() and p.read_bytes() for p in path.parent.iterdir()} == before
    return str(caught.value)


@pytest.mark.parametrize("ending", ["sdf", "xml"])
def test_a_true_vehicle_that_leaves_no_payload_is_refused_by_its_keys(ending, mujoco, tmp_path):
    (tmp_path / f"x.{ending}").write_text("mine")
    light = tl.load_mission("paper", {"plant.mass_scale": 0.8})
    assert "plant.mass_scale = 0.8" in check_refused(light, tmp_path / f"x.{ending}")
    thin = tl.load_mission("paper", {"plant.inertia_scale": [0.97, 1.4, 1.1]})
    assert "principal moments of" in check_refused(thin, tmp_path / f"x.{ending}")


def test_endings_and_ports_that_do_not_fit_are_refused(tmp_path):
    mission = tl.load_mission("paper")
    for name in ("world", "world.sdf.gz", ".sdf"):
        assert ".sdf (Gazebo world), .xml (MuJoCo model) or .urdf" in check_refused(mission, tmp_path / name)
    assert "'paper' is no flight" in check_refused(mission, tmp_path / "paper.csv")
    for port in (0, -1, 65536):
        assert f"plugin = {port}: must be a port" in check_refused(mission, tmp_path / "paper.sdf", plugin=port)


def test_without_mujoco_its_model_is_refused_and_a_world_is_not(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    for name in [
        f"tandemlift.engines.models.{part}" for part in ("mjcf", "mujoco_bodies", "mujoco_contact", "mujoco_import")
    ]:
        monkeypatch.delitem(sys.modules, name, raising=False)
    mission = tl.load_mission("paper")
    assert "pip install 'tandemlift[mujoco]'" in check_refused(mission, tmp_path / "paper.xml")
    assert export(mission, tmp_path / "paper.sdf").exists()


@pytest.mark.parametrize("ending", ["sdf", "xml"])
def test_a_model_that_cannot_be_written_leaves_what_was_there(ending, mujoco, tmp_path, monkeypatch):
    path = tmp_path / f"old.{ending}"
    path.write_text("mine")

    def full(self, *_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    assert "cannot be written: No space left on device" in check_refused(tl.load_mission("paper"), path)


def test_the_command_writes_a_mission_with_a_changed_key_and_a_plugin(run, tmp_path):
    arguments = ("export", "zigzag", "--set", "corridor.width=6.0", "--plugin", "7000", "--out", "there/wide.sdf")
    code, out, err = run(*arguments)
    assert (code, err) == (0, "")
    assert out.startswith(f"zigzag: {Path('there/wide.sdf')} (")
    wide = tl.load_mission("zigzag", {"corridor.width": 6.0})
    expected = export(wide, tmp_path / "expected.sdf", plugin=7000)
    assert (tmp_path / "there" / "wide.sdf").read_bytes() == expected.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "piece"),
    [
        (("iris", "--out", "iris.obj"), "iris.obj: must end in .mcap"),
        (("nowhere", "--out", "x.sdf"), "nowhere"),
        (("saved", "--out", "iris.sdf", "--set", "mission.duration=5"), "--set is for a mission"),
        (("iris", "--out", "iris.xml", "--plugin", "7000"), "only a world, .sdf, has a plugin"),
        (("iris", "--out", "iris.sdf", "--plugin", "here"), "plugin = here: must be a port"),
    ],
)
def test_the_command_refuses_what_does_not_fit_and_writes_nothing(arguments, piece, run, tmp_path):
    flight_of("iris").save(tmp_path / "saved" / "flight.npz")
    code, out, err = run("export", *arguments)
    assert (code, out) == (2, "")
    assert piece in err
    assert [p.name for p in tmp_path.iterdir()] == ["saved"]
