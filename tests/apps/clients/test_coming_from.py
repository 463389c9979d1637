"""The scripts of the pages for users of other programs, run by the programs of others that can be had."""

import contextlib
import importlib.metadata
import os
import random
import re
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from patience import completed, ended, said
from repository import ROOT

pytestmark = pytest.mark.clients
CLIENTS = {  # by the heading of their section: the page, the client and its version
    "Simulink": ("simulators", "fmpy", "0.3.32"),
    "PX4": ("autopilots", "mavsdk", "4.1.0"),
    "CrazySim": ("autopilots", "cflib", "0.1.34"),
}


def printed(other, folder, change=lambda script: script):
    """What the one script of a section that other tests do not run prints, by the client in its known version."""
    page, client, version = CLIENTS[other]
    assert importlib.metadata.version(client) == version
    text = (ROOT / "docs" / "how-to" / f"coming-from-{page}.md").read_text("utf-8")
    text = text.partition(f"\n## {other}\n")[2].partition("\n## ")[0]
    (script,) = re.findall(r"^```\{code-block\} python\n(.*?)^```", text, re.M | re.S)
    (folder / "script.py").write_text(change(script), "utf-8")
    paths = [str(Path(find_spec(client).origin).parent.parent), os.environ.get("PYTHONPATH", "")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "PYTHONWARNINGS": "ignore"}
    command = [sys.executable, "script.py"]
    done = completed(command, cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@contextlib.contextmanager
def flying(folder, *command):
    """The first UDP port of a command that flies until the end of the block."""
    port = random.SystemRandom().randrange(20000, 60000)
    arguments = [sys.executable, "-m", "tandemlift", *command, "--udp-port", str(port), "--port", "0", "--no-browser"]
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder)
    try:
        said(process, "Ctrl-C")
        yield port
        assert ended(process) == 0
    finally:
        ended(process, signal.SIGKILL)


def test_in_fmpy_the_beam_goes_as_far_as_impulse_over_damping(tmp_path):
    assert f"in FMPy: {1.0 * 2.0 / 1.6:.3f} m" in printed("Simulink", tmp_path)


def test_an_offboard_script_for_one_px4_flies_the_pair(tmp_path):
    with flying(tmp_path, "mavlink", "two-x500") as port:
        lines = printed("PX4", tmp_path, lambda script: script.replace("14540", str(port)))
    assert lines[-1] == "north 1.0 m, down -2.0 m"


def test_a_script_for_two_crazyflies_of_crazysim_flies_ours(tmp_path):
    with flying(tmp_path, "crazyflie") as port:
        lines = printed("CrazySim", tmp_path, lambda s: s.replace("19850", str(port)).replace("19851", str(port + 1)))
    assert sorted(lines) == [f"udp://0.0.0.0:{port + i}: 0.3 m ahead, 0.5 m high" for i in (0, 1)]
