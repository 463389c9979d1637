"""Ten thousand hostile packets of each kind reach a Crazyflie in flight, and the flight goes on as if none had come."""

import random
import struct
from itertools import cycle

import pytest

from tandemlift.apps.clients.crazyflie.commander import GENERIC

pytestmark = pytest.mark.thorough

COUNT, TOGETHER = 10_000, 100  # packets of each kind; those that come between two setpoints
ANSWERED = {15: (0, 1, 3), 13: (1,), 2: (0, 1, 2, 3), 4: (0, 1, 2), 5: (0, 1), 6: (0, 1), 7: (1,), 8: (0,), 9: (0,)}
LENGTHS = {6: 28, 7: 16, 8: 16, 9: 16, 10: 16, 11: 15}  # of setpoints of port 7, after their type
ODD = [struct.pack("<f", number) for number in (float("nan"), float("inf"), float("-inf"))]


def header(port, channel):
    return bytes([port << 4 | 0x0C | channel])


def hover():
    return header(7, 0) + struct.pack("<Bffff", 10, 0.0, 0.0, 0.0, 0.5)


def random_data(rng):
    """Bytes of any content, as many as fit and none."""
    return rng.randbytes(rng.randrange(31))


def kinds(stop):
    """What is sent of each kind, by its name; `stop`: the number of the parameter that stops the rotors."""
    for port, channels in ANSWERED.items():
        for channel in channels:
            if (port, channel) != (2, 2):
                begin = header(port, channel)
                yield f"port {port}, channel {channel}", lambda rng, b=begin: b + random_data(rng)
    yield "port 2, channel 2", lambda rng: header(2, 2) + written(random_data(rng), stop)
    others = [(port, channel) for port in range(16) for channel in range(4) if channel not in known(port)]
    turns = cycle(others)
    yield "ports and channels without a meaning", lambda rng: header(*next(turns)) + random_data(rng)
    yield "setpoints of port 3 of another length", lambda rng: header(3, 0) + wrong_length(rng, 14)
    yield "setpoints of port 7 without a type", lambda rng: header(7, 0)
    types = [n for n in range(256) if n not in GENERIC]
    yield "unknown setpoints of port 7", lambda rng: header(7, 0) + bytes([rng.choice(types)]) + random_data(rng)[1:]
    for kind in [*GENERIC][1:]:
        begin = header(7, 0) + bytes([kind])
        length = LENGTHS[kind]
        yield f"type {kind} of another length", lambda rng, b=begin, n=length: b + wrong_length(rng, n)
        if kind != 6:  # that has no floats
            yield f"type {kind}, not finite", lambda rng, b=begin, n=length: b + not_finite(rng, n)
    yield "orders of the supervisor that are none", lambda rng: header(9, 1) + order(rng)
    yield "packets of any length", lambda rng: any_length(rng)


def known(port):
    return {*ANSWERED.get(port, ()), *{3: (0,), 7: (0,), 9: (1,)}.get(port, ())}


def written(data, stop):
    return data if data[:2] != struct.pack("<H", stop) else b""


def wrong_length(rng, length):
    data = random_data(rng)[:29]
    return data if len(data) != length else data[1:]


def not_finite(rng, length):
    """Floats of which one at least is none, and what follows them (a thrust that is not zero)."""
    data = bytearray(struct.pack("<4f", *(rng.gauss(0.0, 1.0) for _ in range(4)))[:length])
    if length < 16:
        data[12:] = b"\xff\x7f\x01"
    at = 4 * rng.randrange(length // 4)
    data[at : at + 4] = rng.choice(ODD)
    return bytes(data)


def order(rng):
    """Nothing, an arming without saying which, or a code that is none (1 to 4 are: arm, recover, stop, watchdog)."""
    return rng.choice([b"", b"\x01", bytes([rng.randrange(5, 256)]) + random_data(rng)[1:]])


def any_length(rng):
    """Bytes of any length, of any port if they are too long for a packet, else of one without a meaning."""
    packet = rng.randbytes(rng.randrange(2000))
    return packet if len(packet) > 31 else (header(14, 2) + packet[1:31] if packet else packet)


def test_ten_thousand_hostile_packets_of_each_kind_do_not_disturb_a_hover(pair):
    rng, device = random.Random(5), pair.devices[0]
    stop = [name for name, *_ in device._parameter.table.entries].index("stabilizer.stop")
    pair.seconds(4.0, lambda: device.receive(hover()))
    start = pair.state().position
    every = list(kinds(stop))
    for name, make in every:
        for k in range(COUNT):
            if k % TOGETHER == 0:
                pair.flight.step(2)  # by what the last hostile packets left
                device.receive(hover())  # its client alone flies both
            device.receive(make(rng))
        assert pair.state().position == pytest.approx(start, abs=0.02), name
        assert pair.quads.is_flying(0), name
        assert device.receive(header(15, 0) + b"still here") == [header(15, 0) + b"still here"], name
    assert device.refused > len(every) * COUNT / 3
    assert pair.flight.simulation.ending is None
