"""What tests of clients share: a flight of two Crazyflies on a rod, a step at a time."""

from importlib.util import find_spec

import pytest

import tandemlift as tl
from tandemlift.apps.clients.crazyflie.device import Crazyflie
from tandemlift.apps.clients.flight import SteppedFlight, quadrotors_of

collect_ignore_glob = [] if find_spec("pymavlink") else ["test_mavlink_*.py"]
ASIDE = {"pushes": [], "pilot.push": "truth", "pilot.state": "truth", "phases.land_start": 1e6}


def stick(**changes):
    """The mission of two Crazyflies, whose own pilot does nothing."""
    return tl.load_mission("crazyflie-stick", {**ASIDE, "mission.duration": 1000.0, **changes})


class Pair:
    """Two Crazyflies in a flight without a clock, both armed; and the quadrotors behind them."""

    def __init__(self, *arguments, **more):
        mission = stick(**more)
        self.quads = quadrotors_of(mission, *arguments)
        self.devices = [Crazyflie(self.quads, i) for i in range(2)]
        self.sent = [[], []]  # packets that each sent by itself
        self.quads.ticks.append(self._tick)
        self.flight = SteppedFlight(mission, self.quads)
        self.seconds(0.01)
        for i in range(2):
            self.quads.arm(i)

    def _tick(self, now):
        for device, sent in zip(self.devices, self.sent, strict=True):
            sent.extend(device.tick(now))

    def seconds(self, time, each=None, every=0.1):
        """Fly on for a time [s]; call `each` at an interval, as a client sends setpoints."""
        steps = round(every / self.flight.simulation.dt)
        for _ in range(max(round(time / every), 1)) if each else [None]:
            if each:
                each()
            self.flight.step(steps if each else max(round(time / self.flight.simulation.dt), 1))

    def both(self, packet):
        """Send a packet to both."""
        return [device.receive(packet) for device in self.devices]

    def state(self, i=0):
        return self.quads.state(i)


@pytest.fixture
def pair():
    """Two Crazyflies that stand on the floor, armed."""
    return Pair()


@pytest.fixture(scope="session")
def pairs():
    """Makes a pair with other control or other keys."""
    return Pair


@pytest.fixture
def world():
    """Two X500 that stand on the floor, and a MAVLink client of each."""
    from mavlink_world import World

    made = World()
    yield made
    made.close()
