"""The engine over ROS 1, as far as it goes without ROS and without Gazebo."""

from xml.etree import ElementTree

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.apps.export.write import export
from tandemlift.engines.gazebo import world_from
from tandemlift.engines.models.sdf import rotors_of
from tandemlift.engines.rospy import RosMaster, joined


@pytest.fixture
def mission():
    return tl.load_mission("hover")


def test_what_may_be_joined_is_a_master_or_a_world(monkeypatch):
    for given in ("", "master", "world"):
        monkeypatch.setenv("TANDEMLIFT_GAZEBO_ROS", given)
        assert joined() == given
    monkeypatch.setenv("TANDEMLIFT_GAZEBO_ROS", "1")
    with pytest.raises(tl.InputError, match="TANDEMLIFT_GAZEBO_ROS = 1: must be 'master' or 'world'"):
        joined()


def test_a_root_without_ros_is_told_how_to_get_it(monkeypatch, tmp_path):
    (tmp_path / "usr/bin").mkdir(parents=True)
    (tmp_path / "usr/bin/gzserver").touch()
    monkeypatch.setenv("TANDEMLIFT_GAZEBO_ROOT", str(tmp_path))
    with pytest.raises(tl.InputError, match=r"^engine 'gazebo-ros' needs ROS 1 .* running tools/gazebo-root again"):
        RosMaster()


def test_a_world_over_ros_says_its_rotors_to_the_last_bit(mission):
    plugin = ElementTree.fromstring(world_from(mission, "ros", namespace="/here").encode()).find("world/model/plugin")
    assert plugin.get("filename") == "libtandemlift_gazebo_ros.so"
    told = {setting.tag: setting.text for setting in plugin}
    rotors = [float(word) for word in told.pop("rotors").split()]
    assert told == {"wait": "true", "patience": "0", "stay": "false", "namespace": "/here"}
    np.testing.assert_array_equal(rotors, rotors_of(tl.Vehicle.from_settings(mission.vehicle)).ravel())


def test_a_world_is_exported_for_ros_by_name(mission, tmp_path):
    text = export(mission, tmp_path / "hover.sdf", plugin="ros").read_text("utf-8")
    assert "libtandemlift_gazebo_ros.so" in text
    with pytest.raises(tl.InputError, match="plugin = rosbag: must be a port, from 1 to 65535, or 'ros'"):
        export(mission, tmp_path / "hover.sdf", plugin="rosbag")
