"""The Crazyflies of a vehicle over UDP, a port each from 19850 on: one datagram is one CRTP packet.

One client at a time flies a Crazyflie. Another one finds it by scanning, and is let in once the first is silent.
"""

from __future__ import annotations

import selectors
import socket
import threading
import time
from contextlib import suppress
from typing import Self

from tandemlift import InputError
from tandemlift.apps.clients.crazyflie.device import Channel, Crazyflie
from tandemlift.apps.clients.crazyflie.tables import CrtpParameter, fits
from tandemlift.apps.clients.flight import RealTimeFlight
from tandemlift.apps.clients.mission_numbers import mission_numbers
from tandemlift.apps.clients.quadrotors import Quadrotors

PORT = 19850  # cflib, crtp/udpdriver.py: scans ten ports from here
SILENT = 1.0  # s without a packet, after which another client may take over; cflib sends ten a second
NULL = 0xFF  # header of the null packet
WAIT = 0.2  # s, between looks at whether to stop
Address = tuple[str, int]


class Endpoint:
    """A Crazyflie, its socket, and the client that flies it."""

    def __init__(self, device: Crazyflie, listening: socket.socket) -> None:
        self.device, self.socket, self.lock = device, listening, threading.RLock()
        self._client: Address | None = None
        self._waiting: tuple[bytes, Address] | None = None
        self._heard = 0.0

    def receive(self) -> None:
        """Receive a packet, and answer it."""
        try:
            packet, address = self.socket.recvfrom(2048)
        except OSError:  # some systems tell here that an earlier answer was not taken
            return
        if len(packet) == 1 and packet[0] == NULL:  # it scans
            self._send(packet, address)
        elif address == self._client or self._client is None or self._is_silent():
            self._take(packet, address)
        else:
            self._waiting = packet, address

    def take_waiting(self) -> None:
        """Let a client in that waits, once the other one is silent: cflib asks only once."""
        if self._waiting and self._is_silent():
            self._take(*self._waiting)

    def _is_silent(self) -> bool:
        return time.monotonic() - self._heard > SILENT

    def _take(self, packet: bytes, address: Address) -> None:
        """Answer a packet of the client that flies from now on."""
        with self.lock:
            if address != self._client:
                self._client, self._waiting = address, None
                self.device.log.blocks.clear()
            self._heard = time.monotonic()
            for answer in self.device.receive(packet):
                self._send(answer, address)

    def tick(self, flight_time: float, again: bool = False) -> None:
        """Go on to a time of the flight [s], of one that begins `again`."""
        with self.lock:
            if again:
                self.device.restart()
            for packet in self.device.tick(flight_time):
                if self._client is not None and not self._is_silent():
                    self._send(packet, self._client)

    def _send(self, packet: bytes, address: Address) -> None:
        with suppress(OSError):  # the client is gone, or the network
            self.socket.sendto(packet, address)


class CrazyflieServer:
    """Listens for the clients of all Crazyflies while it is entered.

    Args:
        quadrotors: of the vehicle.
        flight: in real time, whose keys and channels are in the tables; without one, only the firmware's are.
        host: to listen on.
        port: of the first one.
    """

    def __init__(
        self, quadrotors: Quadrotors, flight: RealTimeFlight | None = None, host: str = "127.0.0.1", port: int = PORT
    ) -> None:
        self._host, self._port = host, port
        parameters = parameters_of(flight) if flight else {}
        channels = channels_of(flight) if flight else {}
        self.devices = [Crazyflie(quadrotors, i, dict(parameters), channels) for i in range(quadrotors.count)]
        self._endpoints: list[Endpoint] = []
        self._now, self._stopping = 0.0, threading.Event()
        self._thread = threading.Thread(target=self._listen, name="crazyflies", daemon=True)
        quadrotors.ticks.append(self._tick)

    @property
    def addresses(self) -> list[str]:
        """The addresses of the Crazyflies, as cflib takes them."""
        return [f"udp://{self._host}:{one.socket.getsockname()[1]}" for one in self._endpoints]

    def __enter__(self) -> Self:
        """Listen.

        Raises:
            InputError: a port is in use, or is none.
        """
        for i, device in enumerate(self.devices):
            listening = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            try:
                listening.bind((self._host, self._port + i if self._port else 0))
            except (OSError, OverflowError) as error:
                listening.close()
                self._close()
                raise InputError(
                    f"--udp-port {self._port}: Crazyflie {i + 1} cannot listen on {self._host}:{self._port + i} "
                    f"({error}); another simulator may run there: end it, or give another port"
                ) from error
            listening.setblocking(False)
            self._endpoints.append(Endpoint(device, listening))
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Listen no more."""
        self._stopping.set()
        self._thread.join()
        self._close()

    def _close(self) -> None:
        for one in self._endpoints:
            one.socket.close()
        self._endpoints = []

    def _listen(self) -> None:
        with selectors.DefaultSelector() as selector:
            for one in self._endpoints:
                selector.register(one.socket, selectors.EVENT_READ, one)
            while not self._stopping.is_set():
                for key, _ in selector.select(WAIT):
                    key.data.receive()
                for one in self._endpoints:
                    one.take_waiting()

    def _tick(self, now: float) -> None:
        """Go on to a time of the flight [s]; an earlier one than before begins a new flight."""
        again, self._now = now < self._now, now
        for one in self._endpoints:
            one.tick(now, again)


def channels_of(flight: RealTimeFlight) -> dict[str, Channel]:
    """The channels of a flight whose names fit into a table."""
    return {f"{group}.{name}": ("f", read) for group, name, read in flight.channels() if fits(group, name)}


def parameters_of(flight: RealTimeFlight) -> dict[str, CrtpParameter]:
    """The numbers of a mission that can be changed in flight and whose names fit into a table."""
    numbers = mission_numbers(flight)
    return {
        f"{g}.{name}": CrtpParameter("f", one.read(), one.take, read=one.read)
        for g, name, one in numbers
        if fits(g, name)
    }
