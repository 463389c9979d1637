"""`tandemlift live` as a process whose compiler takes long: what is served, shown and heeded before it flies."""

import json
import os
import re
import subprocess
import sys
import urllib.request

import numpy as np
import pytest
import slow_compiler
from patience import PATIENCE, ended, said, until
from websockets.sync.client import connect

from tandemlift.apps.live.session.frames import read_frames


@pytest.fixture
def compiling(tmp_path):
    """A live flight that is compiled until `goes_on` is there: its process, its address, that file."""
    goes_on = tmp_path / "goes on"
    command = [sys.executable, slow_compiler.__file__, "live", "zigzag", "--no-browser", "--port=0"]
    environment = {
        **os.environ,
        "TANDEMLIFT_CACHE": str(tmp_path / "cache"),
        "COMPILES_UNTIL": str(goes_on),
        "PYTHONPATH": os.pathsep.join(sys.path),
    }
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True, env=environment)
    try:
        yield process, said(process, r"http://\S+")[0], goes_on
    finally:
        assert ended(process) == 0


class Viewer:
    """What a viewer is told."""

    def __init__(self, socket):
        self.socket, self.scenes, self.fields = socket, 0, ()

    def text(self, true):
        """The next text of which something is true."""
        while True:
            got = self.socket.recv(PATIENCE)
            if isinstance(got, str):
                told = json.loads(got)
                self.scenes += told["type"] == "scene"
                if true(told):
                    return told

    def frame(self):
        """The next frame's fields."""
        while not isinstance(got := self.socket.recv(PATIENCE), bytes):
            self.scenes += json.loads(got)["type"] == "scene"
        return {name: values[0] for name, values in read_frames(self.fields, got).items()}


def viewer_at(address):
    where = {"uri": address.replace("http", "ws") + "ws", "origin": address.rstrip("/")}
    return connect(**where, open_timeout=PATIENCE, ping_timeout=None)


@pytest.mark.thorough
def test_page_scene_and_vehicle_are_there_while_it_compiles_and_then_it_flies_whoever_has_left(compiling):
    _, address, goes_on = compiling
    with viewer_at(address) as socket:
        Viewer(socket).text(lambda told: told["type"] == "status")
    with urllib.request.urlopen(address, timeout=PATIENCE) as page:
        assert b"page.js" in page.read()
    with viewer_at(address) as socket:
        viewer = Viewer(socket)
        scene = viewer.text(lambda told: told["type"] == "scene")
        viewer.fields = tuple(map(tuple, scene["fields"]))
        step = "compiling the flight loop"  # a moment before it is another one
        status = viewer.text(lambda told: told["type"] == "status" and told["preparing"]["step"] == step)
        assert status["phase"] == "preparing"
        first = viewer.frame()
        assert first["time"] == 0.0
        assert np.linalg.norm(first["attitude"]) == pytest.approx(1.0)
        socket.send(json.dumps({"type": "reset", "seq": 1}))
        refused = viewer.text(lambda told: told["type"] == "refused")
        assert refused["reason"] == "the flight is still being prepared"
        goes_on.touch()
        assert viewer.text(lambda told: told["type"] == "status" and "preparing" not in told)["phase"] == "idle"
        flown = until(lambda: next((f for f in [viewer.frame()] if f["time"] > 0.5), None), "half a second of flight")
        np.testing.assert_allclose(flown["position"], first["position"], atol=0.05)
        assert viewer.scenes == 1, "the page need not be built again"


def test_a_mission_that_cannot_be_flown_is_refused_before_anything_is_served(run, monkeypatch):
    monkeypatch.setattr("tandemlift.apps.live.server.serve_until_interrupt", None)
    for wrong in ("--engine=none", "--set=controller.name=none", "--set=mission.step=1"):
        code, said, errors = run("live", "hover", "--no-browser", "--port=0", wrong)
        assert (code, said) == (2, "")
        assert re.fullmatch(r"error: .*\n", errors)
