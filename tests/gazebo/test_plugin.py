"""The plugin when pilots die, come back and interfere, and when a person pushes by Gazebo's own topic."""

import random
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from patience import ended, said

from tandemlift.core.types import GRAVITY
from tandemlift.engines.gazebo import GazeboBody
from tandemlift.engines.gazebo_wire import HEADER, MAGIC, VERSION, Wire
from tandemlift.engines.models.sdf import rotors_of

from .conftest import SILENT, fly, rest_and_fly

pytestmark = pytest.mark.gazebo
HOLD = 0.1  # s
PUSH = "/gazebo/default/tandemlift/push"
PILOT = """
import sys
import numpy as np
from tandemlift.engines.gazebo_wire import Wire
port, weight = int(sys.argv[1]), float(sys.argv[2])
wire = Wire(port, 2)
state = np.array([0, 0, 5, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0], dtype=float)
wire.hello(1e-3, np.array(sys.argv[3].split(), dtype=float), state)
wire.thrusts[:] = weight / 8
print("flying", flush=True)
while True:
    wire.advance()
"""


def pushed(gazebo, wire, text, steps=600, topic=PUSH):
    """A flight of at least that many steps after Gazebo's own tool has said this, and of those meanwhile."""
    script = ["topic", "-p", topic, "-m", f'data: "{text}"' if topic == PUSH else text]
    told = []
    with ThreadPoolExecutor(1) as pool:
        tool = pool.submit(gazebo.gz, *script)
        while not tool.done():  # `gz` is ended if it does not end
            told.append(wire.advance().numbers[3:].copy())
            time.sleep(0.001)
    tool.result()
    told.extend(wire.advance().numbers[3:].copy() for _ in range(steps))
    return np.array(told)


def test_a_vehicle_whose_pilot_is_silent_is_held_for_a_moment_then_falls(gazebo):
    wire = gazebo.wire()
    fly(wire, 10, amplitude=0.0)
    ended = wire.answer.clock[0]
    time.sleep(SILENT + 0.8)
    told = gazebo.wire(place=False).answer
    falling = told.clock[0] - ended - HOLD
    assert falling > 0.1  # s
    assert told.state[5] == pytest.approx(-GRAVITY * falling, abs=2.5 * GRAVITY * gazebo.dt)  # rounded to steps
    np.testing.assert_allclose(told.state[[3, 4, 10, 11, 12]], 0.0, atol=1e-9)


def test_a_pilot_that_rests_is_not_given_up(gazebo, monkeypatch):
    monkeypatch.setenv("TANDEMLIFT_GAZEBO_PORT", str(gazebo.port))
    body = GazeboBody(gazebo.mission, gazebo.vehicle)
    rest_and_fly(body, gazebo.vehicle, SILENT)
    body.close()


def test_a_pilot_that_was_given_up_is_told_so(gazebo):
    wire = gazebo.wire()
    fly(wire, 3)
    time.sleep(SILENT + 0.5)
    with pytest.raises(ConnectionError, match=r"refuses step 4: the session is over"):
        wire.advance()


def test_twenty_pilots_killed_at_any_moment_leave_a_server_that_flies_to_the_last_bit(gazebo):
    before, chance = fly(gazebo.wire(), 300), random.Random(1)
    rotors = " ".join(map(repr, rotors_of(gazebo.vehicle).ravel().tolist()))
    arguments = [sys.executable, "-c", PILOT, str(gazebo.port), repr(gazebo.vehicle.weight), rotors]
    for _ in range(20):
        pilot = subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True)
        said(pilot, "^flying$")
        time.sleep(chance.uniform(0.0, 0.1))
        ended(pilot, signal.SIGKILL)
        gazebo.server.check()
        if chance.random() < 0.5:  # the next one comes while it waits, or after it was given up
            time.sleep(SILENT + 0.3)
    after = fly(gazebo.wire(), 300)
    assert np.array_equal(after, before)


def test_what_is_lost_doubled_or_late_changes_no_bit(gazebo):
    sound, chance, wire = fly(gazebo.wire(), 300), random.Random(2), gazebo.wire()
    send, old = wire._socket.send, [b""]

    def badly(message):
        again, late = message == old[-1], chance.choice(old)
        old.append(bytes(message))
        sound = [[message], [message] * 2, [late, message], [message, late]]
        for sent in chance.choice(sound if again else [[], *sound]):
            send(sent)

    class Bad:
        def __getattr__(self, name):
            return badly if name == "send" else getattr(own, name)

    own, wire._socket = wire._socket, Bad()
    assert np.array_equal(fly(wire, 300), sound)


def test_nonsense_on_the_port_is_survived(gazebo):
    wire = gazebo.wire()
    other = Wire(gazebo.port, 2)
    chance = random.Random(3)
    for size in (0, 1, HEADER.size - 1, HEADER.size, 100, 1400):
        other._socket.send(chance.randbytes(size))
        head = HEADER.pack(MAGIC, VERSION, chance.randrange(9), chance.getrandbits(32), 2, chance.getrandbits(63))
        other._socket.send(head + chance.randbytes(size))
    other.close()
    assert len(fly(wire, 50)) == 50


def test_numbers_that_are_not_finite_are_refused(gazebo):
    wire = gazebo.wire()
    wire.thrusts[3] = np.nan
    with pytest.raises(ConnectionError, match=r"refuses step 1: a number in the message is not finite"):
        wire.advance()


def test_a_push_by_topic_is_held_for_its_duration_at_its_point(gazebo):
    wire = gazebo.wire()
    fly(wire, 10, amplitude=0.0)
    told = pushed(gazebo, wire, "force 1 0 0 point 0 1 0 duration 0.25")
    force = told[:, -6:-3]
    acting = np.flatnonzero(force[:, 0])
    assert len(acting) == 250  # steps
    assert np.all(np.diff(acting) == 1)
    np.testing.assert_array_equal(force[acting], [[1.0, 0.0, 0.0]] * 250)
    assert told[acting[0], -1] == pytest.approx(-1.0)  # N m about z
    assert told[-1, 3] == pytest.approx(0.25 / gazebo.vehicle.mass, rel=1e-6)  # m/s: the impulse
    assert told[-1, 12] < -0.01  # rad/s


def test_a_push_that_cannot_be_read_is_refused_with_its_form(gazebo):
    wire = gazebo.wire()
    assert not pushed(gazebo, wire, "force 1 0", steps=200)[:, -6:].any()
    assert "say: force FX FY FZ [point X Y Z] [duration S]" in gazebo.server.last_output()


WRENCH = "/gazebo/default/tandemlift/quadrotor_2/wrench"
NONE = "x: 0 y: 0 z: 0"


def test_a_wrench_of_gazebo_s_own_is_a_push_of_known_force_and_unknown_moment(gazebo):
    wire = gazebo.wire()
    fly(wire, 10, amplitude=0.0)
    told = pushed(gazebo, wire, f"force {{x: 8.0 y: 0 z: 0}} torque {{{NONE}}}", topic=WRENCH)
    force = told[:, -6:-3]
    assert np.count_nonzero(np.abs(force[:, 0]) > 1.0) == 1  # it acts for one step
    np.testing.assert_allclose(force.sum(axis=0), [8.0, 0.0, 0.0], atol=1e-6)
    assert np.isnan(told[:, -3:]).all(axis=1).sum() in (1, 2)  # of that step, and of that in which it was heard of
    assert not told[:, -9:-6].any()  # and is no contact
    step = int(np.argmax(force[:, 0]))
    assert told[step, 3] - told[step - 1, 3] == pytest.approx(8.0 * gazebo.dt / gazebo.vehicle.mass, rel=1e-6)  # m/s


def test_a_torque_of_gazebo_s_own_leaves_the_moment_unknown(gazebo):
    told = pushed(gazebo, gazebo.wire(), f"force {{{NONE}}} torque {{x: 0 y: 0 z: 3.0}}", topic=WRENCH)
    assert np.isnan(told[:, -3:]).any()
    assert told[-1, 12] > 5e-4  # rad/s
