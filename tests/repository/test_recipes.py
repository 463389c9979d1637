"""The recipes of CONTRIBUTING.md for what touches a few files, followed in a copy of the package.

The other recipes name the tests that follow them.
"""

from __future__ import annotations

import json

import pytest
from edited_package import EditedPackage
from listings import LAW as LISTED_CONTROLLER

Edits = dict[str, list[tuple[str, str]]]  # texts to be replaced by others, by file; "" by a new file's text


SPIN_UP = "    spin_up_time: NonNegative = key("
NEW_KEY = '    idle_time: NonNegative = key(0.2, "s", "time of idling after a landing", source="chosen: short")\n'
KEY: Edits = {"parts/guidance/compliance_table.py": [(SPIN_UP, NEW_KEY + SPIN_UP)]}
KEY_IS_KNOWN = """
import tandemlift as tl
from tandemlift.missions.reference import explained
from tandemlift.missions.schema import mission_schema
from tandemlift.missions.reference import template_text

name, meaning = "compliance.idle_time", "time of idling after a landing"
assert explained(name).split() == (
    f"{name} [s]: {meaning} Allowed: a number ≥ 0. Default: 0.2 (chosen: short).".split()), explained(name)
said = mission_schema()["properties"]["compliance"]["properties"]["idle_time"]
assert (said["minimum"], said["default"]) == (0, 0.2) and meaning in said["description"]
assert any("idle_time = 0.2" in line and meaning in line for line in template_text().splitlines())
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
    "parts/interaction/admittance.py": [
        (ADMITTANCE, GATE + ADMITTANCE),
        (ANCHORED, SMOOTH + ANCHORED),
        ('gate: Literal["hard", "soft"]', 'gate: Literal["hard", "soft", "smooth"]'),
        (CHOICE, '"smooth": "F³/(F² + threshold²)", ' + CHOICE),
        ("else HardGate", 'else SmoothGate if a.gate == "smooth" else HardGate'),
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


SENSOR_LAW = """

@register_sensor(additional("rangefinder", "m", "height above the floor at z = 0"))
@law
def floor_distance(sensor: Any, state: State, perfect: PerfectReadings) -> Number:
    return state.position.z
"""
NORTH = "NORTH = Vec3(1.0, 0.0, 0.0)  # world axes; the inclination of the field is left out\n"
CORRECTED = "    return centre_of_mass(k, after), after\n"
USED = """    rangefinder = getattr(readings.additional, "rangefinder", None)
    if rangefinder is not None:
        above = rangefinder.value - centre_of_mass(k, after).position.z
        after = after._replace(position=after.position + UP * (above * 0.5 * rangefinder.fresh))
"""
SENSOR: Edits = {
    "parts/sensors/additional_sensors.py": [(NORTH, NORTH + SENSOR_LAW)],
    "parts/estimation/navigation.py": [(CORRECTED, USED + CORRECTED)],
}
SENSOR_IS_USED = """
import tandemlift as tl

def error_of_height(additional):
    flight = tl.fly(tl.load_mission("paper", {
        "mission.duration": 3.0, "pushes": [], "sensors.model": "simulated", "pilot.state": "estimate",
        "sensors.additional": additional,
        "sensor_faults": [{"sensor": "position", "kind": "bias", "time": 0.0, "size": [0.0, 0.0, 0.2]}],
    }))
    return abs(flight["estimated_position"][-1, 2] - flight["position"][-1, 2])

assert error_of_height([]) > 0.15
assert error_of_height([{"name": "rangefinder"}]) < 0.02
"""


FINDING: Edits = {
    "core/findings.py": [
        ('    "lift-refused",\n]', '    "lift-refused",\n    "high",\n]'),
        (
            "KINDS = (\n",
            'KINDS = (\n    FindingKind("high", "the vehicle was higher than 1 m", "lower `phases.height`"),\n',
        ),
    ],
    "simulation/findings.py": [
        (
            "        *_touches(flight_state),\n",
            "        *_high(flight_state, steps * p.dt),\n        *_touches(flight_state),\n",
        ),
        (
            "def _oscillations(",
            """def _high(flight_state: FlightState, end: float) -> Iterator[Finding]:
    highest = flight_state.metrics.highest
    if highest > 1.0:
        yield finding("high", f"the vehicle was at {highest:.3g} m", time=end, value=highest, unit="m", limit=1.0)


def _oscillations(""",
        ),
    ],
}
FINDING_IS_FOUND = """
import tandemlift as tl

def found(height, **more):
    mission = tl.load_mission("hover", {"mission.duration": 1.0, "initial.position": [0.0, 0.0, height], **more})
    return [f.kind for f in tl.fly(mission).findings]

assert "high" in found(1.5) and "high" not in found(0.5)
assert "high" not in found(1.5, **{"findings.ignore": ["high"]})
"""


METRIC: Edits = {
    "simulation/loop/running_metrics.py": [
        (
            "    push_active: Number\n    height: Number\n",
            "    push_active: Number\n    height: Number\n    speed: Number\n",
        ),
        ("    highest: Number\n    estimate", "    highest: Number\n    fastest: Number\n    estimate"),
        ("    highest=-math.inf,\n", "    highest=-math.inf,\n    fastest=0.0,\n"),
        (
            "        highest=maximum(c.highest, x.height),\n",
            "        highest=maximum(c.highest, x.height),\n        fastest=maximum(c.fastest, x.speed),\n",
        ),
        (
            "        height=x.position.z,\n",
            "        height=x.position.z,\n        speed=sqrt(maximum(dot(x.velocity, x.velocity), 1e-24)),\n",
        ),
        (
            '        "push_triggers_after_10s"',
            '        "speed_max_m_s": max(early.fastest, late.fastest),\n        "push_triggers_after_10s"',
        ),
    ],
    "flight/metric_descriptions.py": [
        (
            '            "position_rmse_m": Metric(',
            '            "speed_max_m_s": Metric("m/s", "largest speed"),\n            "position_rmse_m": Metric(',
        ),
    ],
}
METRIC_IS_FORMED = """
import numpy as np
import tandemlift as tl

flight = tl.fly(tl.load_mission("paper", {"mission.duration": 3.0, "mission.log_interval": 1e-3, "mission.step": 1e-3}))
assert flight.metrics()["speed_max_m_s"] == np.linalg.norm(flight["velocity"], axis=1).max() > 0.1
"""


LIST = "from tandemlift.parts.controllers import geometric"
CONTROLLER: Edits = {
    "parts/controllers/my_pd.py": [("", LISTED_CONTROLLER)],
    "parts/controllers/__init__.py": [(LIST, LIST.replace("geometric", "my_pd, geometric"))],
}
CONTROLLER_FLIES = """
import tandemlift as tl
from tandemlift.missions.reference import explained

metrics = tl.fly(tl.load_mission("hover", {"controller.name": "my-pd", "controller.stiffness": 9.0})).metrics()
assert abs(metrics["final_position_m"][2] - metrics["final_reference_m"][2]) < 0.01
assert "[controller] of my-pd" in explained("controller", "my-pd")
"""


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

RECIPES = {
    "a key touches one file": (KEY, KEY_IS_KNOWN),
    "a variant of a law touches its law, its key and where it is chosen": (LAW, LAW_FLIES),
    "a sensor that an estimator uses touches its law and the estimator": (SENSOR, SENSOR_IS_USED),
    "a finding touches two files": (FINDING, FINDING_IS_FOUND),
    "a metric touches two files": (METRIC, METRIC_IS_FORMED),
    "the controller of the guide becomes one of the package by an import": (CONTROLLER, CONTROLLER_FLIES),
    "an engine is a class and an entry": (ENGINE, ENGINE_FLIES),
}
RUN_ALL = """
import json, traceback
wrong = {}
for name, script in SCRIPTS.items():
    try:
        exec(script, {})
    except Exception:
        wrong[name] = traceback.format_exc()
print(json.dumps(wrong))
"""


@pytest.fixture(scope="module")
def wrong(tmp_path_factory) -> dict[str, str]:
    """What fails in a copy of the package that follows all recipes: tracebacks by recipe."""
    package = EditedPackage(tmp_path_factory.mktemp("recipes"))
    for edits, _ in RECIPES.values():
        for path, changes in edits.items():
            for before, after in changes:
                package.replace(path, before, after) if before else package.write(path, after)
    scripts = {name: script for name, (_, script) in RECIPES.items()}
    return json.loads(package.run(f"SCRIPTS = {scripts!r}\n{RUN_ALL}"))


@pytest.mark.parametrize("recipe", RECIPES)
def test_a_recipe_does_what_it_says(recipe, wrong):
    assert recipe not in wrong, wrong[recipe]
