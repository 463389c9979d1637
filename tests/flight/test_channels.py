"""The channels of a flight: those of the parts that its mission has, each of its width, all of them in the table."""

import numpy as np
import pytest
from edited_package import EditedPackage
from reference_tables.channels import channel_tables

import tandemlift as tl
from tandemlift.core.types import leaves
from tandemlift.core.vector import Absent
from tandemlift.flight.channels import CHANNELS, DERIVED, STAMP
from tandemlift.flight.channels import GROUPS as CHANNEL_GROUPS
from tandemlift.parts.estimation.contact_detection import ContactEstimateChannels
from tandemlift.parts.guidance.disturbance_observer import DisturbanceChannels
from tandemlift.parts.guidance.hand_guidance import HandGuidanceChannels
from tandemlift.parts.guidance.policy import PolicyChannels
from tandemlift.parts.guidance.supervision import SupervisionChannels
from tandemlift.parts.mechanics.structure import ShapeChannels
from tandemlift.parts.mechanics.wind import WindChannels
from tandemlift.parts.rotor_loss.detection import DetectionChannels
from tandemlift.simulation.loop.estimate_channels import EstimatedChannels, MeasuredChannels
from tandemlift.simulation.loop.log_sample import (
    ActuatorChannels,
    ContactChannels,
    Sample,
)
from tandemlift.simulation.loop.running_metrics import EMPTY
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import RawResult, flight_of

GROUPS = {
    "shape": ShapeChannels,
    "actuators": ActuatorChannels,
    "wind": WindChannels,
    "contact": ContactChannels,
    "measured": MeasuredChannels,
    "additional": Absent,
    "estimated": EstimatedChannels,
    "contact_estimate": ContactEstimateChannels,
    "disturbance": DisturbanceChannels,
    "guidance": HandGuidanceChannels,
    "supervised": SupervisionChannels,
    "policy": PolicyChannels,
    "detection": DetectionChannels,
}


def channels_in(names):
    """The channels that fields of a sample stand for, group by group, groups within groups too."""
    return [channel for name in names for channel in (channels_in(GROUPS[name]._fields) if name in GROUPS else [name])]


ALWAYS = [name for name in Sample._fields if name not in GROUPS]


def test_a_step_logs_the_channels_of_the_record_and_no_others_in_its_order():
    assert list(CHANNELS) == [*channels_in(Sample._fields), *STAMP]
    assert len(CHANNELS) == sum(len(group.channels) for group in CHANNEL_GROUPS), "a name in two groups"
    assert not set(DERIVED) & set(CHANNELS)


def test_a_channel_says_its_unit_its_meaning_and_in_which_frame_a_vector_is():
    assert all(channel.unit and channel.meaning for channel in CHANNELS.values())
    assert [name for name, channel in CHANNELS.items() if channel.width > 1 and not channel.frame] == []
    assert {channel.per for channel in CHANNELS.values()} == {"", "rotor", "quadrotor"}


def test_the_tables_of_the_documents_name_every_channel():
    assert [name for name in CHANNELS if f"| `{name}` |" not in channel_tables()] == []


def unflown(changes, count=2):
    """The record of mission iris with changes and so many quadrotors, before anything was flown."""
    quadrotor = tl.load_mission("iris").vehicle.quadrotors[0].model_dump(exclude_none=True)
    fleet = [quadrotor | {"position": [1.2 * i, 1.0, 0.075]} for i in range(count)]
    p = FlightPlan(tl.load_mission("iris", {"vehicle.quadrotors": fleet, **changes}))
    row = np.zeros(leaves(p.sample))
    return flight_of(p, RawResult(p.model.flight_state, EMPTY, 0, row[None], row, 0.0))


BARE = {"pilot": {"state": "truth", "push": "truth"}, "phases.rotors": "always"}
WHOLE = BARE | {
    "pilot": {"state": "truth", "push": "measurement"},
    "vehicle.payload": {"length": 2.0, "radius": 0.011, "material": "pine"},
    "wind.model": "air",
    "supervision.model": "on",
    "compliance.policy.model": "network",
    "contact.model": "on",
    "detection.model": "residual",
}
PARTS = {  # a part that a mission may have, what takes it out, and the group of channels that goes with it
    "shape": {"vehicle.payload.material": None},
    "actuators": {"actuators.model": "ideal", "ground.effect": False},
    "contact": {"ground": {"model": "none", "effect": False}},
    "measured, estimated": BARE | {"sensors.model": "none", "contact.model": "none"},
    "contact_estimate": {"contact.model": "none"},
    "wind": {"wind.model": "none"},
    "disturbance": {"observer.model": "none"},
    "guidance, contact_estimate": {
        "pilot.guidance": "scheduled",
        "supervision.model": "none",
        "compliance.policy.model": "none",
        "contact.model": "none",
    },
    "supervised": {"supervision.model": "none"},
    "policy": {"compliance.policy.model": "none"},
    "detection": {"detection.model": "none"},
}


def test_a_mission_with_all_parts_has_all_channels():
    assert list(unflown(WHOLE)) == list(CHANNELS)


@pytest.mark.parametrize("groups", PARTS)
def test_channels_are_not_there_if_the_mission_has_not_their_part(groups):
    missing = channels_in(groups.split(", ")) + [*STAMP] * groups.startswith("measured")
    assert list(unflown(WHOLE | PARTS[groups])) == [name for name in CHANNELS if name not in missing]


@pytest.mark.parametrize("count", [1, 4])
def test_all_channels_have_their_widths(count):
    flight = unflown(WHOLE, count)
    widths = {name: (1 if array.ndim == 1 else array.shape[1]) for name, array in flight.items()}
    assert widths == {name: channel.columns(count, 4 * count) for name, channel in CHANNELS.items()}


def test_a_flight_of_three_quadrotors_has_rows_of_these_widths():
    count, quadrotor = 3, tl.load_mission("paper").vehicle.quadrotors[0].model_dump()
    spread = [quadrotor | {"position": [1.2 * i, 1.0, 0.1]} for i in range(count)]
    flight = tl.fly(tl.load_mission("flight-ready", {"vehicle.quadrotors": spread, "mission.duration": 0.05}))
    widths = {name: (1 if array.ndim == 1 else array.shape[1]) for name, array in flight.items()}
    assert widths == {name: CHANNELS[name].columns(count, 4 * count) for name in ALWAYS}
    assert {len(array) for array in flight.values()} == {len(flight.time)} == {6}
    assert np.allclose(flight["rotor_thrusts"].sum(axis=1), flight["thrust"], rtol=1e-12)


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


@pytest.mark.thorough
def test_a_channel_is_added_by_its_record_and_the_law_that_logs_it(tmp_path):
    package = EditedPackage(tmp_path)
    package.insert("flight/channels.py", 'Channel("N", "world", "force of the air on all parts together"),', RECORD)
    package.insert("parts/mechanics/wind.py", "    wind_force: Vec3", FIELD)
    package.insert("parts/mechanics/wind.py", "wind_velocity=velocity,", VALUE)
    assert package.run(PROGRAM) == "followed\n"
