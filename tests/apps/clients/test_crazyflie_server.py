"""Crazyflies on UDP: scans, one client at a time, ports in use, and a flight that goes on."""

import socket
import struct
import threading

import numpy as np
import pytest
from patience import PATIENCE, joined, until

import tandemlift as tl
from tandemlift.apps.clients.crazyflie import server as crazyflie_server
from tandemlift.apps.clients.crazyflie.server import CrazyflieServer
from tandemlift.apps.clients.flight import PILOT_ASIDE, RealTimeFlight, quadrotors_of
from tandemlift.core.files import parse_setting

HOST = "127.0.0.1"


@pytest.fixture(autouse=True)
def _patient(monkeypatch):
    """A client that is silent, as on a busy machine, is not taken for one that is gone."""
    monkeypatch.setattr(crazyflie_server, "SILENT", PATIENCE)


@pytest.fixture
def served():
    """A server of two Crazyflies without a flight, and their addresses."""
    with CrazyflieServer(quadrotors_of(tl.load_mission("crazyflie-stick")), port=0) as server:
        yield server, [(HOST, int(address.rpartition(":")[2])) for address in server.addresses]


@pytest.fixture
def client():
    """Makes sockets of clients."""
    made = []

    def make():
        made.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        made[-1].settimeout(PATIENCE)
        return made[-1]

    yield make
    for one in made:
        one.close()


def asked(client, address, packet):
    client.sendto(packet, address)
    return client.recv(100)


def test_each_crazyflie_answers_a_scan_on_its_port(served, client):
    for address in served[1]:
        assert asked(client(), address, b"\xff") == b"\xff"


def test_a_second_client_is_answered_only_when_it_scans_until_the_first_is_silent(served, client, monkeypatch):
    _, (address, _) = served
    first, second = client(), client()
    assert asked(first, address, b"\xfc\0mine") == b"\xfc\0mine"
    second.sendto(b"\xfc\0yours", address)
    assert asked(second, address, b"\xff") == b"\xff"  # and no echo before
    monkeypatch.setattr(crazyflie_server, "SILENT", 0.0)
    assert second.recv(100) == b"\xfc\0yours"  # what it asked meanwhile


def test_ten_thousand_datagrams_of_any_content_leave_it_answering(served, client):
    rng, one, (server, (address, _)) = np.random.default_rng(6), client(), served
    for k in range(10_000):
        one.sendto(rng.bytes(int(rng.integers(0, 1500))), address)
        if k % 25 == 24:  # so that none is lost on the way, although the server gets no processor
            answer, echo = b"", b"\xfc" + str(k).encode()
            one.sendto(echo, address)
            while answer != echo:
                answer = one.recv(100)
    assert server.devices[0].refused > 1_000


def test_a_port_in_use_is_refused_with_what_to_do(client):
    taken = client()
    taken.bind((HOST, 0))
    quads = quadrotors_of(tl.load_mission("crazyflie-stick"))
    for port, which in (taken.getsockname()[1], 1), (65535, 2):  # the second one's would be 65536
        server = CrazyflieServer(quads, port=port)
        with (
            pytest.raises(
                tl.InputError, match=rf"--udp-port {port}: Crazyflie {which} cannot listen .* give another port"
            ),
            server,
        ):
            pass


@pytest.mark.thorough
def test_a_flight_in_real_time_logs_and_its_keys_can_be_set(client, tmp_path):
    mission = tl.load_mission("crazyflie-stick", dict(map(parse_setting, PILOT_ASIDE)))
    quads = quadrotors_of(mission)
    flight = RealTimeFlight(mission, quads, "compiled", tmp_path)
    with CrazyflieServer(quads, flight, port=0) as server:
        device, address = server.devices[0], (HOST, int(server.addresses[0].rpartition(":")[2]))
        names = [name for name, *_ in device.log.table.entries]
        one = client()
        block = struct.pack("<BBBHBH", 6, 1, 0x77, names.index("position.z"), 0x77, names.index("stateEstimate.z"))
        assert asked(one, address, b"\x5d" + block)[-1] == 0
        assert asked(one, address, b"\x5d\x03\x01\x01")[-1] == 0
        flight.session.start()
        try:
            packets = [one.recv(100) for _ in range(20)]
            assert {packet[0] for packet in packets} == {0x5E}
            centre, own = struct.unpack("<ff", packets[-1][5:])
            assert own - centre == pytest.approx(quads.vehicle.lever_arms[0][2], abs=1e-6)
            assert device.parameters["wind.velocity_1"].take(struct.pack("<f", 0.5))
            until(lambda: flight.session.flight.now.wind.velocity[0] == 0.5)
            assert not device.parameters["wind.velocity_1"].take(struct.pack("<f", 99.0))
            flight.session.apply(read("set"))  # by a page
            assert device.parameters["wind.velocity_2"].data == struct.pack("<f", 0.25)
            quads.arm(0)
            for message in ("rewind", "save"):
                with pytest.raises(tl.InputError, match="not while clients fly"):
                    flight.session.apply(read(message))
            flight.session.apply(read("reset"))
            until(lambda: quads.has_states and not quads.is_armed(0))
        finally:
            flight.session.stop()


def read(kind):
    """A message of a page."""
    from tandemlift.apps.live.session.page_messages import read_message

    wind = ', "key": "wind.velocity", "value": [0.5, 0.25, 0]'
    more = {"rewind": ', "time": 0.0', "save": ', "name": "mine"', "set": wind}.get(kind, "")
    return read_message(f'{{"type": "{kind}", "seq": 1{more}}}')


def test_a_flight_that_begins_again_changes_log_blocks_only_with_the_lock(served, monkeypatch):
    server, _ = served
    endpoint, held = server._endpoints[0], []

    def restart():
        other = threading.Thread(target=lambda: held.append(not endpoint.lock.acquire(blocking=False)))
        other.start()
        joined(other)

    monkeypatch.setattr(endpoint.device, "restart", restart)
    server._tick(2.0)
    server._tick(1.0)
    assert held == [True]
