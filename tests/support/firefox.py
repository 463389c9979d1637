"""Debian's Firefox, driven by WebDriver BiDi: pages, scripts, and actions of a person."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from patience import PATIENCE, ended, until
from screen import Screen
from websockets.sync.client import connect

FIREFOX, XVFB = shutil.which("firefox-esr"), shutil.which("Xvfb")
if not (FIREFOX and XVFB) and not os.environ.get("TANDEMLIFT_REQUIRE_ALL"):
    pytest.skip("Debian's Firefox or Xvfb is not installed", allow_module_level=True)


SETTINGS = 'user_pref("webgl.force-enabled", true);\n'  # also without a graphics card


class Firefox:
    """A browser with one page; errors of the page are in `wrong`."""

    def __init__(self, socket: Any) -> None:
        self._socket, self._numbers, self.wrong = socket, itertools.count(), list[str]()
        self.command("session.new", capabilities={})
        self.command("session.subscribe", events=["log.entryAdded"])
        self._page = self.command("browsingContext.getTree")["contexts"][0]["context"]

    def command(self, method: str, **params: Any) -> Any:
        """The result of a command."""
        number = next(self._numbers)
        self._socket.send(json.dumps({"id": number, "method": method, "params": params}))
        while True:
            told = json.loads(self._socket.recv(timeout=PATIENCE))
            if told.get("id") == number:
                assert told["type"] == "success", told
                return told["result"]
            if told.get("method") == "log.entryAdded" and told["params"]["level"] == "error":
                self.wrong.append(told["params"]["text"])

    def open(self, address: str, width: int = 1000, height: int = 600) -> None:
        """Open a page."""
        size = {"width": width, "height": height}
        self.command("browsingContext.setViewport", context=self._page, viewport=size)
        self.command("browsingContext.navigate", context=self._page, url=address, wait="complete")

    def value(self, expression: str) -> Any:
        """The value of an expression in the page, which JSON can hold; promises are awaited."""
        text = f"(async () => JSON.stringify(await ({expression})))()"
        asked = {"expression": text, "target": {"context": self._page}, "awaitPromise": True}
        found = self.command("script.evaluate", **asked)
        assert found["type"] == "success", found
        return json.loads(found["result"].get("value", "null"))

    def drag(self, start: tuple[float, float], way: tuple[float, float], pieces: int = 20) -> None:
        """Press, move in some pieces, and stay pressed."""
        x, y = start

        def to(share: float, **more: int) -> dict[str, Any]:
            return {"type": "pointerMove", "x": round(x + way[0] * share), "y": round(y + way[1] * share), **more}

        moves = [to(i / pieces, duration=25) for i in range(1, pieces + 1)]
        press = [to(0.0), {"type": "pointerDown", "button": 0}]
        self._act({"type": "pointer", "id": "mouse", "actions": [*press, *moves]})

    def drop(self) -> None:
        """Let go."""
        self._act({"type": "pointer", "id": "mouse", "actions": [{"type": "pointerUp", "button": 0}]})

    def press(self, key: str) -> None:
        """Press a key, by its character in WebDriver."""
        actions = [{"type": kind, "value": key} for kind in ("keyDown", "keyUp")]
        self._act({"type": "key", "id": "keys", "actions": actions})

    def _act(self, actions: dict[str, Any]) -> None:
        self.command("input.performActions", context=self._page, actions=[actions])


@contextlib.contextmanager
def firefox() -> Iterator[Firefox]:
    """A browser without windows, with a profile of its own."""
    with tempfile.TemporaryDirectory() as profile:
        (Path(profile) / "user.js").write_text(SETTINGS, "utf-8")
        screen = Screen(XVFB or "Xvfb", Path(profile) / "screen")  # without one, Firefox has no WebGL
        command = [FIREFOX or "firefox-esr", "--no-remote", "--profile", profile, "--remote-debugging-port=0"]
        environment = os.environ | {"DISPLAY": screen.name, "LIBGL_ALWAYS_SOFTWARE": "1"}
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
        try:
            port = Path(profile) / "WebDriverBiDiServer.json"
            until(lambda: port.exists() and port.read_text().strip().endswith("}"), "a port of Firefox")
            server = json.loads(port.read_text())
            address = f"ws://{server['ws_host']}:{server['ws_port']}/session"
            with connect(address, max_size=2**26, open_timeout=PATIENCE, compression=None) as socket:
                yield Firefox(socket)
        finally:
            process.terminate()
            ended(process)
            screen.close()
