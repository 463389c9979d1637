"""What the front publishes of a flight, against the flight itself."""

import numpy as np
import pytest
from ros_trial import UP, Middleware, wrench
from scipy.spatial.transform import Rotation

from tandemlift.apps.export import topics
from tandemlift.apps.export.coordinate_frames import fixed
from tandemlift.apps.live.session.scene_builder import scene_of
from tandemlift.apps.ros.scenery import still
from tandemlift.missions import load_mission
from tandemlift.parts.mechanics.vehicle import Vehicle

PUSHED = ("base_world", (1.5, 0.5, 0.0))


@pytest.fixture(scope="module")
def flown(one_trial):
    trial = one_trial
    trial.fly(UP)
    for _ in range(4):
        trial.heed(wrench(*PUSHED))
        trial.fly(0.4)
    trial.flight = trial.session.flight.snapshot().save(trial.session._out / "flown")
    return trial


def stamps(messages):
    return np.array([m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in messages])


def test_topics_are_those_of_bags_and_a_few_besides(flown):
    vehicle = Vehicle.from_settings(flown.session.flight.now.vehicle)
    bags = {t.name: t.kind for t in topics.topics_from(flown.flight, vehicle)}
    bags |= {"/tf": "tf2_msgs/TFMessage", "/tf_static": "tf2_msgs/TFMessage"}
    bags |= {"/diagnostics": "diagnostic_msgs/DiagnosticArray", "/tandemlift/mission": "std_msgs/String"}
    more = {
        "/tandemlift/markers/still": "visualization_msgs/MarkerArray",
        "/tandemlift/markers/moving": "visualization_msgs/MarkerArray",
        "/tandemlift/path": "nav_msgs/Path",
        "/tandemlift/reference/path": "nav_msgs/Path",
        "/tandemlift/robot_description": "std_msgs/String",
        "/clock": "rosgraph_msgs/Clock",
    }
    assert flown.middleware.kinds == bags | more
    assert flown.middleware.latched == {
        *("/tf_static", "/tandemlift/mission", "/tandemlift/markers/still", "/tandemlift/robot_description")
    }


def test_every_sample_is_published_with_the_flight_s_numbers_evenly_apart(flown):
    messages, flight = flown.sent("/tandemlift/odometry"), flown.flight
    count = len(flight.time)
    assert len(messages) >= count
    assert np.all(np.diff(stamps(messages[:count])) == 10_000_000)
    place = [[p.x, p.y, p.z] for p in (m.pose.pose.position for m in messages[:count])]
    assert np.array_equal(place, flight["position"])
    turned = Rotation.from_quat(flight["attitude"], scalar_first=True)
    velocity = [[v.x, v.y, v.z] for v in (m.twist.twist.linear for m in messages[:count])]
    assert np.abs(turned.apply(velocity) - flight["velocity"]).max() < 1e-14
    pushes = [[f.x, f.y, f.z] for f in (m.wrench.force for m in flown.sent("/tandemlift/push/true")[:count])]
    assert np.array_equal(pushes, flight["push_force"])
    assert np.abs(pushes).max() > 1.0


def test_who_does_not_listen_costs_nothing(trial):
    channel = trial.middleware.channels["/tandemlift/odometry"]
    channel.wanted, before = False, len(channel.sent)
    trial.fly(0.1)
    assert len(channel.sent) == before
    assert trial.sent("/tandemlift/push/true")


def test_frames_are_where_the_vehicle_s_parts_are(flown):
    vehicle = Vehicle.from_settings(flown.session.flight.now.vehicle)
    (message,) = flown.sent("/tf_static")
    told = {t.child_frame_id: [getattr(t.transform.translation, a) for a in "xyz"] for t in message.transforms}
    assert told == {name: at.tolist() for name, at in fixed(vehicle)}
    moving = flown.sent("/tf")[-1].transforms
    assert [t.child_frame_id for t in moving] == ["base_link", "base_world"]


def test_phases_are_told_as_they_change(flown):
    assert flown.said() == ["lift", "guided"]


def markers(trial, topic, name):
    return {m.id: m for array in trial.sent(topic) for m in array.markers if m.ns == name and m.action == 0}


def test_the_vehicle_is_drawn_in_its_own_frame_and_walls_where_the_mission_has_them(trial):
    vehicle = markers(trial, "/tandemlift/markers/still", "vehicle")
    assert len(vehicle) > 50
    assert all(m.header.frame_id == "base_link" and m.frame_locked for m in vehicle.values())
    beam = max(vehicle.values(), key=lambda m: m.scale.z)
    assert beam.scale.z == trial.session.flight.now.vehicle.payload.length
    q = beam.pose.orientation
    along = Rotation.from_quat([q.x, q.y, q.z, q.w]).apply([0.0, 0.0, 1.0])
    assert np.abs(along[1]) == pytest.approx(1.0)


def test_walls_stand_where_the_mission_has_them():
    mission = load_mission("zigzag")
    vehicle = Vehicle.from_settings(mission.vehicle)
    drawn = still(Middleware().types, scene_of(mission, "compiled"), vehicle).markers
    boxes = [m for m in drawn if m.ns == "surroundings" and m.type == 1][1:]
    assert len(boxes) == len(mission.all_walls)
    for box, wall in zip(boxes, mission.all_walls, strict=True):
        q, at = box.pose.orientation, box.pose.position
        along = Rotation.from_quat([q.x, q.y, q.z, q.w]).apply([box.scale.x / 2.0, 0.0, 0.0])
        assert np.array([at.x, at.y]) + along[:2] == pytest.approx(np.array(wall.end), abs=1e-12)
        assert at.z + box.scale.z / 2.0 == pytest.approx(wall.top)


def test_the_push_is_an_arrow_from_where_it_acts_as_long_as_it_is_strong(flown):
    drawn = markers(flown, "/tandemlift/markers/moving", "push")
    start, end = (np.array([p.x, p.y, p.z]) for p in drawn[0].points)
    assert end - start == pytest.approx(0.22 * np.array(flown.channel("push_force")), abs=0.01)
    assert drawn[1].text == "1.6 N"


def test_ways_are_what_was_flown_and_what_was_asked_for(flown):
    path = flown.sent("/tandemlift/path")[-1]
    last = path.poses[-1].pose.position
    assert path.header.frame_id == "world"
    assert [last.x, last.y, last.z] in flown.flight["position"].tolist()


def test_how_it_goes_is_told_with_numbers(flown):
    reports = [s for array in flown.sent("/diagnostics") for s in array.status if s.name == "tandemlift: flight"]
    assert reports
    assert {v.key for v in reports[-1].values} >= {"samples in the last second", "flown [s]", "alarm"}
