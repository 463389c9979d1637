"""Two Crazyflies flown by UDP packets: what is lost, and how late answers and logs come.

Each gets a hover setpoint and an echo request at 100 Hz, and logs a block at 100 Hz. Printed for each: echoes and
logged samples that are missing, quantiles of the echo's round trip and of the interval between logged samples, and the
height that was held. On a quiet machine; the client is a process of its own, as a real one is.

    python benchmarks/crazyflie_clients.py --minutes 60
"""

from __future__ import annotations

import argparse
import re
import socket
import struct
import subprocess
import sys
import time

import numpy as np

RATE, HEIGHT = 100.0, 0.6  # Hz, m
HOVER, ECHO, LOG, ARM = b"\x7c", b"\xfc", b"\x5d", b"\x9d\x01\x01"


class Client:
    """One client: a socket, and what came."""

    def __init__(self, address: str) -> None:
        host, _, port = address.removeprefix("udp://").rpartition(":")
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect((host, int(port)))
        self.socket.settimeout(5.0)
        self.sent = 0
        self.trips: list[float] = []
        self.stamps: list[int] = []
        self.came: list[float] = []
        self.heights: list[float] = []

    def begin(self) -> None:
        """Arm, and log the height every 10 ms."""
        (number,) = [n for n in range(200) if self.entry(n) == b"stateEstimate\0z\0"]
        for packet in (LOG + b"\x05", LOG + struct.pack("<BBBH", 6, 1, 0x77, number), LOG + b"\x03\x01\x01", ARM):
            self.socket.send(packet)
            self.socket.recv(64)
        self.socket.settimeout(0.0)

    def entry(self, number: int) -> bytes:
        """The names of an entry of the log table."""
        self.socket.send(struct.pack("<BBH", 0x5C, 2, number))
        return self.socket.recv(64)[5:]

    def send(self) -> None:
        """Send a setpoint and an echo request with the time."""
        self.socket.send(HOVER + struct.pack("<Bffff", 10, 0.0, 0.0, 0.0, HEIGHT))
        self.socket.send(ECHO + struct.pack("<Bd", 0, time.perf_counter()))
        self.sent += 1

    def receive(self) -> None:
        """Take all that has come."""
        while True:
            try:
                packet = self.socket.recv(64)
            except BlockingIOError:
                return
            now = time.perf_counter()
            if packet[:1] == ECHO:
                self.trips.append(now - struct.unpack("<d", packet[2:])[0])
            elif packet[0] == 0x5E:
                self.stamps.append(int.from_bytes(packet[2:5], "little"))
                self.came.append(now)
                self.heights.append(struct.unpack("<f", packet[5:])[0])

    def report(self) -> str:
        """A line."""
        gaps = np.diff(self.stamps) % 2**24
        trips, pauses = 1000.0 * np.array(self.trips), 1000.0 * np.diff(self.came)
        return (
            f"echoes lost {self.sent - len(self.trips)} of {self.sent}; samples lost {int(np.sum(gaps // 10 - 1))} of "
            f"{len(self.stamps)}; round trip {np.median(trips):.2f} ms, p99 {np.quantile(trips, 0.99):.2f}, most "
            f"{trips.max():.1f}; between samples p99 {np.quantile(pauses, 0.99):.1f} ms; height "
            f"{np.median(self.heights[len(self.heights) // 2 :]):.3f} m"
        )


def main() -> None:
    """Fly, and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=60.0)
    minutes = parser.parse_args().minutes
    command = [sys.executable, "-m", "tandemlift", "crazyflie", "--no-browser", "--port", "0", "--udp-port", "19860"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout
        line = next(line for line in server.stdout if "Quadrotors:" in line)
        while "Ctrl-C" not in server.stdout.readline():
            pass
        clients = [Client(address) for address in re.findall(r"udp://\S+?:\d+", line)]
        for client in clients:
            client.begin()
        due = time.perf_counter()
        end = due + 60.0 * minutes
        while due < end:
            for client in clients:
                client.send()
            due += 1.0 / RATE
            while time.perf_counter() < due:
                for client in clients:
                    client.receive()
                time.sleep(0.0005)
        time.sleep(0.5)
        for number, client in enumerate(clients, 1):
            client.receive()
            print(f"Crazyflie {number}: {client.report()}")
        server.terminate()


if __name__ == "__main__":
    main()
