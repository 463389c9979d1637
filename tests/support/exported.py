"""Flights to export, with random numbers in every channel, and the messages written from them."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
from messages_as_numbers import flat

import tandemlift as tl
from tandemlift.flight.channels import CHANNELS
from tandemlift.flight.record import Ending, Flight
from tandemlift.missions import tables_of

SAMPLES = 40


def anything(name, count, rng):
    """Random numbers for a channel of a vehicle with `count` quadrotors."""
    columns = CHANNELS[name].columns(count, 4 * count)
    if name.endswith("attitude"):
        q = rng.standard_normal((SAMPLES, 4))
        return q / np.linalg.norm(q, axis=1, keepdims=True)
    return rng.standard_normal((SAMPLES, columns) if columns > 1 else SAMPLES)


def flight_of(mission, **changes):
    """A flight with random numbers in every channel, so that no two columns are equal."""
    tables = tables_of(tl.load_mission(mission))
    rng = np.random.default_rng(7)
    channels = {name: anything(name, len(tables["vehicle"]["quadrotors"]), rng) for name in CHANNELS}
    channels["phase"] = np.repeat([0.0, 1.0, 4.0, 2.0], SAMPLES // 4)
    time = np.arange(SAMPLES, dtype=np.float64) * 0.0123
    channels |= {"imu_stamp": time - 0.001, "joints_stamp": time - 0.0025}
    channels["motion_stamp"] = np.repeat(time[::2] - 0.008, 2)  # a sample for two rows
    return replace(Flight(time, channels, tables, {"events": []}), **changes)


def eventful():
    """A flight of two quadrotors with events, a failing sensor, and an early end."""
    events = [[0.0, "idle"], [0.05, "no lift: not level"], [0.1, "lift"], [0.123456, "rotor failed -> land"]]
    made = flight_of("iris", results={"events": events}, ending=Ending("roll [deg]", 0.48, 91.0, "must be"))
    made.channels["measured_velocity"][3] = np.nan
    made.channels["measured_attitude"][5] = np.nan
    made.channels["measured_attitude"][6] *= 1.02  # a reading need not be of unit norm
    return made


def mcap_of(path):
    """All messages of a ROS 2 bag: topic → [(type, time, leaves)]."""
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    found = {}
    with path.open("rb") as file:
        for schema, channel, message, decoded in make_reader(
            file, decoder_factories=[DecoderFactory()]
        ).iter_decoded_messages(log_time_order=False):
            assert message.publish_time == message.log_time
            found.setdefault(channel.topic, []).append((schema.name, message.log_time, flat(decoded)))
    return found


def numbers(messages, *paths):
    """The numbers at some paths of all messages of a topic, one row per message."""
    return np.array([[leaves[path] for path in paths] for _, _, leaves in messages])


def xyz(path, last=""):
    return [f"{path}.{axis}" for axis in f"xyz{last}"]


def stamps(times):
    """Times as stamps: one second later, rounded once to the nearest nanosecond."""
    return [10**9 + round(Fraction(float(t)) * 10**9) for t in times]
