"""The page's own flights in Node.js: the worker that ships, and a clock that the tests set."""

from __future__ import annotations

import base64
import io
import json
import os
import shutil
import subprocess
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tandemlift.apps.live.page_files import PAGE_FOLDER
from tandemlift.apps.live.page_modules import FORMAT, PackedFlight
from tandemlift.apps.live.session.frames import read_frames
from tandemlift.core.files import __version__
from tandemlift.missions import load_mission
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.stepping import fly_stepwise

HERE = Path(__file__).parent
INDEX = {"format": FORMAT, "version": __version__, "broken": "broken", "other_version": "other"}

if not os.environ.get("TANDEMLIFT_REQUIRE_ALL") and shutil.which("node") is None:
    pytest.skip("Node.js is not installed", allow_module_level=True)


class OwnFlight:
    """A flight in the worker.

    Args:
        flight: as a page carries it.
        settings: of a link, as pairs of key and value.
        page: folder of the page.
    """

    def __init__(self, flight: PackedFlight, settings: list[Any] | None = None, page: Path = PAGE_FOLDER) -> None:
        command = ["node", str(HERE / "page_worker.mjs"), str(page / "worker.js")]
        self._node = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.said = self._open("open", flight, settings or [])
        self.scene = next((one for one in self.said if one["type"] == "scene"), None)

    def _open(self, kind: str, flight: PackedFlight, settings: list[Any]) -> list[Any]:
        entry = {"name": flight.name, "sha256": flight.sha256, "data": base64.b64encode(flight.data).decode()}
        return self._ask(type=kind, index=INDEX, entry=entry, settings=settings, file=None)

    def along(self, flight: PackedFlight) -> list[Any]:
        """Let another flight go along as a ghost; what the worker answers."""
        return self._open("along", flight, [])

    def _ask(self, **what: Any) -> list[Any]:
        assert self._node.stdin
        assert self._node.stdout
        self._node.stdin.write(json.dumps(what) + "\n")
        self._node.stdin.flush()
        return json.loads(self._node.stdout.readline())

    def say(self, kind: str, **what: Any) -> list[Any]:
        """Send a message; what the worker answers."""
        return self._ask(type=kind, seq=1, **what)

    def fly(self, seconds: float) -> None:
        """Let time pass."""
        dt = self.scene["step"]
        self.said = self._ask(fly=round(seconds / dt), dt=dt) or self.said

    def status(self) -> dict[str, Any]:
        """The latest status."""
        return next(one for one in reversed(self.said) if one["type"] == "status")

    def seen(self, which: int = 0) -> dict[str, Any]:
        """The latest frame, by field; `which`: 1 for that of the ghost."""
        frame = next(one for one in reversed(self.said) if one["type"] == "frame")
        fields = tuple(map(tuple, self.scene["fields"]))
        return {name: value[which] for name, value in read_frames(fields, bytes.fromhex(frame["values"])).items()}

    def saved(self, folder: Path, name: str = "mine") -> np.ndarray:
        """Save the flight into a folder; its last sample."""
        (answer,) = [one for one in self.say("save", name=name) if one["type"] == "saved"]
        assert answer["name"] == f"{name}.zip"
        zipfile.ZipFile(io.BytesIO(bytes.fromhex(answer["bytes"]))).extractall(folder)
        return np.load(folder / "last_sample.npy")

    def close(self) -> None:
        """End Node.js."""
        self._node.communicate()


def check_done(flight: OwnFlight, moves: Iterable[tuple[str, dict[str, Any], float]]) -> None:
    """Say what moves say, each flown for its seconds; none may be refused."""
    for kind, what, seconds in moves:
        said = flight.say(kind, **what)
        assert not [one for one in said if one["type"] == "refused"], said
        flight.fly(seconds)


def check_flies_again(file: Path, last: np.ndarray) -> None:
    """Check that a saved mission ends in Python, bit for bit, as it did in the page."""
    plan = FlightPlan(load_mission(file))
    again = fly_stepwise(plan, plan.steps + 1, 1)
    np.testing.assert_array_equal(again.last.view(np.int64), last.view(np.int64))
