"""The recipe "Add a channel" of CONTRIBUTING.md, followed: two files say it, and all that has channels has it."""

import pytest
from edited_package import EditedPackage

pytest.importorskip("rosbags.rosbag1")

RECORD = """
            "wind_speed": Channel("m/s", "", "speed of the air", 1),"""
FIELD = """
    wind_speed: Number"""
VALUE = """
        wind_speed=sqrt(dot(velocity, velocity)),"""
PROGRAM = """
import numpy as np
import tandemlift as tl
from tandemlift.apps.export.reading import read_bag
from tandemlift.apps.export.write import export
from reference_tables.channels import channel_tables

wind = {"wind.model": "air", "wind.velocity": [3.0, -4.0, 0.0], "wind.turbulence": 6.0}
flight = tl.fly(tl.load_mission("iris", {"mission.duration": 0.05, **wind}))
speed = np.linalg.norm(flight["wind_velocity"], axis=1)
assert speed.min() > 1.0 and np.ptp(speed) > 0.0
np.testing.assert_allclose(flight["wind_speed"], speed, rtol=1e-14)
assert flight.info("wind_speed").unit == "m/s"
assert np.array_equal(tl.Flight.load(flight.save("flight.npz"))["wind_speed"], flight["wind_speed"])
assert "wind_speed[m/s]" in export(flight, "flight.csv").read_text().splitlines()[0].split(",")
assert np.array_equal(read_bag(export(flight, "flight.bag"))["wind_speed"], flight["wind_speed"])
assert "| `wind_speed` | 1 | m/s |  | speed of the air |" in channel_tables()
assert "wind_speed" not in tl.fly(tl.load_mission("paper", {"mission.duration": 0.05}))
print("followed")
"""


def test_a_channel_is_added_by_its_record_and_the_law_that_logs_it(tmp_path):
    package = EditedPackage(tmp_path)
    package.insert("flight/channels.py", 'Channel("N", "world", "force of the air on all parts together"),', RECORD)
    package.insert("simulation/loop/log_sample.py", "    wind_force: Vec3", FIELD)
    package.insert("simulation/loop/log_sample.py", "wind_velocity=velocity,", VALUE)
    package.insert("simulation/loop/log_sample.py", "from tandemlift.core.algebra import clip", ", sqrt")
    assert package.run(PROGRAM) == "followed\n"
