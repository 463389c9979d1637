"""A bag that is written while messages come, read by the `mcap` packages."""

import time
from types import SimpleNamespace

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.typesys import Stores, get_typestore

from tandemlift.apps.export.live_bag import LiveBag
from tandemlift.apps.export.messages import MessageTypes, modern
from tandemlift.apps.ros.middleware import RecordedMiddleware, recorded
from tandemlift.core.errors import InputError

STORE = get_typestore(Stores.ROS2_HUMBLE)
TEXT, POINT = "std_msgs/String", "geometry_msgs/Point"


class Ros:
    """A middleware that no one listens to, whose encoding has five bytes too many, as rclpy's may have."""

    types = MessageTypes(lambda name: STORE.types[modern(name)], numbered=False)

    def __init__(self):
        self.published, self.handlers = [], {}

    def advertise(self, topic, kind, *, latched=False, depth=1):
        return SimpleNamespace(wanted=False, publish=self.published.append)

    def subscribe(self, topic, kind, handle):
        self.handlers[topic] = handle

    def encoded(self, message):
        return bytes(STORE.serialize_cdr(message, message.__msgtype__)) + b"extra"


def read(folder):
    with (folder / f"{folder.name}.mcap").open("rb") as file:
        decoded = make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages()
        return [(channel.topic, message.log_time, len(message.data), one) for _, channel, message, one in decoded]


def test_what_is_sent_and_what_is_heard_is_in_the_bag_with_the_time_at_which_it_came(tmp_path):
    ros, heard, began = Ros(), [], time.time_ns()
    with recorded(ros, str(tmp_path / "deep" / "bag")) as recording:
        assert isinstance(recording, RecordedMiddleware)
        assert recording.types is ros.types
        words = recording.advertise("/words", TEXT, latched=True)
        recording.subscribe("/points", POINT, heard.append)
        point = ros.types[POINT](1.0, 2.0, 3.0)
        assert words.wanted, "though nobody listens"
        words.publish(ros.types[TEXT]("up"))
        ros.handlers["/points"](point)
    words.publish(ros.types[TEXT]("too late"))
    assert heard == [point]
    assert [one.data for one in ros.published] == ["up", "too late"]
    (first, at, size, up), (second, later, _, place) = read(tmp_path / "deep" / "bag")
    assert (first, up.data, size) == ("/words", "up", 4 + 4 + 3)
    assert (second, place.x, place.y, place.z) == ("/points", 1.0, 2.0, 3.0)
    assert began <= at <= later <= time.time_ns()


def test_a_message_of_a_type_that_the_ros_lacks_is_left_out(tmp_path):
    with recorded(Ros(), str(tmp_path / "bag")) as recording:
        recording.advertise("/words", TEXT).publish(None)
    assert read(tmp_path / "bag") == []


def test_a_bag_that_is_there_is_not_written_over(tmp_path):
    with pytest.raises(InputError, match=r"--bag .*: .*exists already"):
        LiveBag(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match=r"--bag .*/file/bag: "):
        LiveBag(tmp_path / "file" / "bag")


def test_ros_1_has_its_own_recorder(tmp_path):
    ros = SimpleNamespace(types=SimpleNamespace(numbered=True))
    with pytest.raises(InputError, match="--bag: needs ROS 2"), recorded(ros, str(tmp_path / "bag")):
        pass
