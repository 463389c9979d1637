"""The recipes of CONTRIBUTING.md for a key, a law, a controller and an engine, followed in a copy of the package.

The other recipes name the tests that follow them.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable

import pytest
from listings import LAW as LISTED_CONTROLLER
from patience import completed
from repository import ROOT

Edits = dict[str, list[tuple[str, str]]]


@pytest.fixture
def with_edits(tmp_path) -> Callable[[Edits, str], None]:
    """Run a script with a copy of the package in which texts are replaced; "" is replaced by a new file's text."""

    def run(edits: Edits, script: str) -> None:
        source = ROOT / "src" / "tandemlift"
        package = shutil.copytree(source, tmp_path / "tandemlift", ignore=shutil.ignore_patterns("__pycache__", "page"))
        for name, changes in edits.items():
            text = (package / name).read_text("utf-8") if (package / name).exists() else ""
            for before, after in changes:
                assert before in text or not text, f"{name}: {before}"
                text = text.replace(before, after, 1) if before else after
            (package / name).write_text(text, "utf-8")
        environment = {**os.environ, "PYTHONPATH": str(tmp_path), "TANDEMLIFT_CACHE": str(tmp_path / "cache")}
        command = [sys.executable, "-c", script]
        done = completed(command, capture_output=True, text=True, env=environment, cwd=tmp_path, check=False)
        assert done.returncode == 0, done.stderr

    return run


SPIN_UP = "    spin_up_time: NonNegative = key("
NEW_KEY = '    idle_time: NonNegative = key(0.2, "s", "time of idling after a landing", source="chosen: short")\n'
KEY: Edits = {"core/settings/guided.py": [(SPIN_UP, NEW_KEY + SPIN_UP)]}
KEY_IS_KNOWN = """
import tandemlift as tl
from tandemlift.missions.key_reference.explaining import explained
from tandemlift.missions.key_reference.markdown import key_tables
from tandemlift.missions.key_reference.schema import mission_schema
from tandemlift.missions.key_reference.template import template_text

name, meaning = "compliance.idle_time", "time of idling after a landing"
assert explained(name).split() == (
    f"{name} [s]: {meaning} Allowed: a number ≥ 0. Default: 0.2 (chosen: short).".split()), explained(name)
said = mission_schema()["properties"]["compliance"]["properties"]["idle_time"]
assert (said["minimum"], said["default"]) == (0, 0.2) and meaning in said["description"]
assert any("idle_time = 0.2" in line and meaning in line for line in template_text().splitlines())
assert f"| `{name}` | s | `0.2`; chosen: short | {meaning}. Allowed: a number ≥ 0 |" in key_tables()
changes = [{"time": 1.0, "key": name, "value": 0.3}]
mission = tl.load_mission("iris", {name: 0.1, "changes": changes, "pilot.guidance": "interactive"})
assert mission.compliance.idle_time == 0.1
try:
    tl.load_mission("iris", {name: -1.0})
except tl.InputError as error:
    assert f"{name} = -1.0: must be a number ≥ 0" in str(error), error
else:
    raise AssertionError("a value that is not allowed")
"""


def test_a_key_touches_one_file(with_edits):
    with_edits(KEY, KEY_IS_KNOWN)


GATE = '''class SmoothGate(NamedTuple):
    """Lets F³/(F² + threshold²) through: without a corner."""

    threshold: Vec3


'''
SMOOTH = '''@elementwise
def smooth(F, threshold):
    """F³/(F² + threshold²)."""
    return F * F * F / (F * F + threshold * threshold)


@gate.register(SmoothGate)
def _smooth(kind, F):
    return smooth(F, kind.threshold)


'''
ADMITTANCE = "class Admittance(NamedTuple):"
ANCHORED = "@elementwise\ndef anchored"
CHOICE = '"hard": "'
LAW: Edits = {
    "parts/compliance/admittance.py": [(ADMITTANCE, GATE + ADMITTANCE), (ANCHORED, SMOOTH + ANCHORED)],
    "core/settings/admittance.py": [
        ('gate: Literal["hard", "soft"]', 'gate: Literal["hard", "soft", "smooth"]'),
        (CHOICE, '"smooth": "F³/(F² + threshold²)", ' + CHOICE),
    ],
    "parts/pilot/assemble.py": [
        ("HardGate, SoftGate", "HardGate, SmoothGate, SoftGate"),
        ("else SoftGate", 'else SmoothGate if a.gate == "smooth" else SoftGate'),
    ],
}
LAW_FLIES = """
import numpy as np
import tandemlift as tl

flight = tl.fly(tl.load_mission("one-push", {"admittance.gate": "smooth", "mission.duration": 6.0}))
F, T = flight["push_force"], np.array(flight.mission["admittance"]["threshold"])
np.testing.assert_allclose(flight["admittance_force"], F**3 / (F**2 + T**2), rtol=1e-12, atol=1e-12)
assert np.abs(F).max() > 1.0
"""


def test_a_variant_of_a_law_touches_its_law_its_key_and_where_it_is_chosen(with_edits):
    with_edits(LAW, LAW_FLIES)


LIST = "from tandemlift.parts.controllers import geometric"
CONTROLLER: Edits = {
    "parts/controllers/my_pd.py": [("", LISTED_CONTROLLER)],
    "parts/controllers/__init__.py": [(LIST, LIST.replace("geometric", "my_pd, geometric"))],
}
CONTROLLER_FLIES = """
import tandemlift as tl
from tandemlift.missions.key_reference.markdown import key_tables

metrics = tl.fly(tl.load_mission("hover", {"controller.name": "my-pd", "controller.stiffness": 9.0})).metrics()
assert abs(metrics["final_position_m"][2] - metrics["final_reference_m"][2]) < 0.01
assert "## `[controller]` of `my-pd`" in key_tables()
"""


def test_the_controller_of_the_guide_becomes_one_of_the_package_by_an_import(with_edits):
    with_edits(CONTROLLER, CONTROLLER_FLIES)


BODY = '''"""A point mass, which does not turn."""

import numpy as np

UP = np.array([0.0, 0.0, 1.0])


class PointBody:
    """The vehicle as a point mass with its thrust along z, by semi-implicit Euler steps."""

    def __init__(self, mission, vehicle, floor, walls):
        self.state, self.readings = np.zeros(13), np.zeros(6 + 6 * vehicle.count)
        self.state[:3], self.state[3:6], self.state[6] = mission.initial.position, mission.initial.velocity, 1.0
        self.mass, self.step = vehicle.mass, mission.mission.step

    def advance(self, thrusts, loads, force, moment):
        acceleration = (thrusts.sum() * UP + force) / self.mass - 9.81 * UP
        self.readings[:3] = acceleration + 9.81 * UP
        self.state[3:6] += acceleration * self.step
        self.state[:3] += self.state[3:6] * self.step
'''
LOADER = """def _point() -> Make:
    from tandemlift.engines.point import PointBody

    return PointBody


class Engine(NamedTuple):"""
ENTRY = "        Engine(\n"
ENGINE: Edits = {
    "engines/point.py": [("", BODY)],
    "engines/registry.py": [
        ("class Engine(NamedTuple):", LOADER),
        (ENTRY, '        Engine("point", "A point mass.", _point),\n' + ENTRY),
    ],
}
ENGINE_FLIES = """
import numpy as np
import tandemlift as tl
from click.testing import CliRunner
from tandemlift.apps.cli.main import cli

assert "A point mass." in CliRunner().invoke(cli, ["engines"]).output
mission = tl.load_mission("hover", {"mission.duration": 8.0})
point, rigid = tl.fly(mission, engine="point"), tl.fly(mission)
assert np.ptp(rigid["position"][:, 2]) > 0.9
np.testing.assert_allclose(point["position"], rigid["position"], atol=1e-3)
"""


def test_an_engine_is_a_class_and_an_entry(with_edits):
    with_edits(ENGINE, ENGINE_FLIES)
