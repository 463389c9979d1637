"""Bitcraze's cflib 0.1.34, unmodified, flies the Crazyflies of a mission: its examples, and its parsers of tables."""

import itertools
import os
import re
import struct
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from patience import PATIENCE, completed, ended, said

import tandemlift as tl
from tandemlift.apps.clients.crazyflie.device import Crazyflie
from tandemlift.apps.clients.flight import quadrotors_of

pytestmark = [pytest.mark.clients, pytest.mark.filterwarnings("ignore")]
SITE = Path(find_spec("cflib").origin).parent.parent if find_spec("cflib") else Path()
EXAMPLES = {  # of cflib's wheel, and a line that each prints where it succeeds
    "logging/basiclog.py": r"stateEstimate.z: 0.03.* pm.vbat: 4.1",
    "logging/basiclog_sync.py": r"'stabilizer.roll'",
    "parameters/basicparam.py": r"Read back: pid_attitude.pitch_kd=0.1234",
    "parameters/persistent_params.py": r"Cleared ring.effect!",
    "parameters/persistent_params_from_file.py": r"stored activeMarker.back!",
    "step-by-step/sbs_connect_log_param.py": r"stabilizer.estimator set at number: 2",
    "step-by-step/sbs_motion_commander.py": r"Deck is attached!",
    "autonomy/motion_commander_demo.py": r"Doing other work",
    "autonomy/autonomous_sequence.py": r"Setting position \(0.5, -0.5, 1.2, 0\)",
    "autonomy/autonomous_sequence_high_level.py": r"The sequence is 7.3 seconds long",
}
NOT_RUN = {  # the others of the wheel, and why not
    "lighthouse/multi_bs_geometry_estimation.py": "base stations of Lighthouse are not simulated",
    "lighthouse/upload_geos.py": "base stations of Lighthouse are not simulated",
    "step-by-step/sbs_swarm.py": "its four radio addresses are in its text",
}
FLY = ("sbs_motion_commander", "motion_commander_demo", "autonomous_sequence")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where clients run: they keep a cache of tables there."""
    return tmp_path_factory.mktemp("cflib")


@pytest.fixture(scope="module")
def crazyflies(folder):
    """The addresses of two Crazyflies that fly in real time."""
    command = [sys.executable, "-m", "tandemlift", "crazyflie", "--no-browser", "--port", "0"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder)
    addresses = re.findall(r"udp://\S+?:\d+", said(process, r"Quadrotors: .*")[0])
    said(process, "Ctrl-C")
    yield addresses
    ended(process)


def run(script, address, folder):
    """The output of a script of a client."""
    paths = os.pathsep.join([str(SITE), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "CFLIB_URI": address, "PYTHONPATH": paths}
    done = completed(
        [sys.executable, "-u", str(script)],
        env=environment,
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


LOOK = """
import os, sys, cflib.crtp
from cflib.crazyflie import Crazyflie
from cflib.crazyflie.log import LogConfig
from cflib.crazyflie.syncCrazyflie import SyncCrazyflie
from cflib.crazyflie.syncLogger import SyncLogger
cflib.crtp.init_drivers()
with SyncCrazyflie(os.environ["CFLIB_URI"], cf=Crazyflie(rw_cache="./cache")) as one:
    log = LogConfig("height", 20)
    log.add_variable("stateEstimate.z", "float")
    log.add_variable("range.zrange", "uint16_t")
    log.add_variable("position.z", "FP16")
    with SyncLogger(one, log) as logger:
        for number, entry in enumerate(logger):
            print(entry[0], *entry[1].values(), flush=True)
            if number == int(os.environ.get("SAMPLES", 5)):
                break
"""


@pytest.fixture(scope="module")
def look(folder):
    """A script that prints time [ms] and height three times over: from the estimate, a range, and our channel."""
    script = folder / "look.py"
    script.write_text(LOOK)
    return script


def test_all_examples_of_the_wheel_are_in_the_list():
    found = {path.relative_to(SITE / "examples").as_posix() for path in (SITE / "examples").rglob("*.py")}
    assert found == EXAMPLES.keys() | NOT_RUN.keys()


def test_cflib_finds_them_by_scanning(crazyflies, monkeypatch):
    from cflib.crtp import udpdriver
    from cflib.crtp.udpdriver import UdpDriver

    assert (
        udpdriver._SCAN_TIMEOUT < 1.0
    )  # s, in which a busy machine may not answer; a port without one refuses at once
    monkeypatch.setattr(udpdriver, "_SCAN_TIMEOUT", PATIENCE)
    assert (
        [found[0] for found in UdpDriver().scan_interface()]
        == crazyflies
        == [
            "udp://127.0.0.1:19850",
            "udp://127.0.0.1:19851",
        ]
    )


@pytest.mark.parametrize("example", EXAMPLES)
def test_an_example_of_cflib_0_1_34_runs_unmodified(example, crazyflies, folder, look):
    heights = None
    if any(name in example for name in FLY):
        environment = {**os.environ, "CFLIB_URI": crazyflies[1], "PYTHONPATH": str(SITE), "SAMPLES": "150"}
        heights = subprocess.Popen(
            [sys.executable, look], env=environment, cwd=folder, stdout=subprocess.PIPE, text=True
        )
    output = run(SITE / "examples" / example, crazyflies[0], folder)
    assert re.search(EXAMPLES[example], output), output[-2000:]
    if heights:
        seen = [float(line.split()[1]) for line in heights.communicate(timeout=PATIENCE)[0].splitlines()]
        assert min(seen) > 0.0  # it never fell
        last = [line.split() for line in run(look, crazyflies[0], folder).splitlines()]
        assert float(last[-1][1]) == pytest.approx(0.0306, abs=0.01)  # it has landed


def test_logs_have_our_channels_under_the_client_s_types(crazyflies, folder, look):
    rows = [list(map(float, line.split())) for line in run(look, crazyflies[1], folder).splitlines()]
    assert [round(b[0] - a[0]) for a, b in itertools.pairwise(rows)] == [20] * (len(rows) - 1)
    for _, height, millimetres, half in rows:
        assert millimetres == pytest.approx(1000.0 * height, abs=1.0)
        assert abs(half - height) < 0.01  # of the centre of mass, a little lower


# tables, against the client's own parsers


@pytest.fixture(scope="module")
def device():
    """A Crazyflie without a socket."""
    return Crazyflie(quadrotors_of(tl.load_mission("crazyflie-stick")), 0)


def entries(device, port):
    """The payloads of all entries of a table."""
    (answer,) = device.receive(bytes([port << 4 | 0x0C, 3]))
    _, count, crc = struct.unpack("<BHI", answer[1:])
    assert crc
    for number in range(count):
        (answer,) = device.receive(struct.pack("<BBH", port << 4 | 0x0C, 2, number))
        assert struct.unpack_from("<BH", answer, 1) == (2, number)
        yield number, bytearray(answer[4:])


def test_every_entry_of_the_log_table_is_read_by_the_client_s_parser(device):
    from cflib.crazyflie.log import LogTocElement

    found = [LogTocElement(number, data) for number, data in entries(device, 5)]
    names = [f"{one.group}.{one.name}" for one in found]
    assert len(set(names)) == len(names) > 40
    assert {"stabilizer.roll", "kalman.varPX", "supervisor.info", "pm.vbat"} <= set(names)
    assert {one.ctype for one in found} <= {"float", "uint16_t", "uint8_t", "int8_t"}


def test_every_entry_of_the_parameter_table_is_read_by_the_client_s_parser(device):
    from cflib.crazyflie.param import ParamTocElement

    found = {f"{one.group}.{one.name}": one for one in (ParamTocElement(n, d) for n, d in entries(device, 2))}
    assert found["deck.bcFlow2"].get_readable_access() == "RO"
    assert found["ring.effect"].is_extended()
    for name, one in found.items():
        (answer,) = device.receive(struct.pack("<BH", 0x2D, one.ident))
        assert answer[3] == 0
        (value,) = struct.unpack(one.pytype, answer[4:])
        assert value == device.parameters[name].value or isinstance(value, float)


def test_quaternions_are_unpacked_as_the_client_packs_them():
    import numpy as np
    from cflib.utils.encoding import compress_quaternion

    from tandemlift.apps.clients.crazyflie.commander import unpacked_quaternion

    for q in np.random.default_rng(1).normal(size=(1000, 4)):
        q /= np.linalg.norm(q)
        w, x, y, z = unpacked_quaternion(compress_quaternion(q))
        assert abs(np.dot(q, (x, y, z, w))) > 1.0 - 5e-6  # 9 bits and a sign for each component
