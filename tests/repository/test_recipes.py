"""The recipes of CONTRIBUTING.md for what touches a few files, followed in a copy of the package.

The other recipes name the tests that follow them.
"""

from __future__ import annotations

import json
import re

import pytest
from edited_package import EditedPackage
from listings import LAW as LISTED_CONTROLLER
from repository import ROOT

PACKAGE = ROOT / "src" / "tandemlift"
Edits = dict[str, list[tuple[str, str]]]  # texts to be replaced by others, by file; "" by a new file's text


SPIN_UP = "    spin_up_time: NonNegative = key("
NEW_KEY = '    max_force: NonNegative = key(100.0, "N", "largest push that moves the reference", source="chosen")\n'
KEY: Edits = {
    "parts/guidance/compliance.py": [
        (SPIN_UP, NEW_KEY + SPIN_UP),
        ("vec3(c.max_jerk), c.braking_gain)", "vec3(c.max_jerk), c.braking_gain, c.max_force)"),
        ("    jerk: Vec3\n    braking_gain: Number\n", "    jerk: Vec3\n    braking_gain: Number\n    force: Number\n"),
        ("with_policy(eased, output.value)", "with_policy(eased, clip(output.value, -k.limits.force, k.limits.force))"),
    ],
}
KEY_HAS_ITS_EFFECT = """
import numpy as np
import tandemlift as tl
from tandemlift.missions.reference import explained
from tandemlift.missions.reference import mission_schema
from tandemlift.missions.reference import template_text

name, meaning = "compliance.max_force", "largest push that moves the reference"
text = f"{name} [N]: {meaning} Allowed: a number ≥ 0. Default: 100.0 (chosen)."
assert explained(name).split() == f'{text} Acts where pilot.guidance = "interactive".'.split()
said = mission_schema()["properties"]["compliance"]["properties"]["max_force"]
assert (said["minimum"], said["default"]) == (0, 100) and meaning in said["description"]
assert any("max_force = 100.0" in line and meaning in line for line in template_text().splitlines())
tl.load_mission("iris", {"changes": [{"time": 1.0, "key": name, "value": 0.3}], "pilot.guidance": "interactive"})
try:
    tl.load_mission("iris", {name: -1.0})
except tl.InputError as error:
    assert f"{name} = -1.0: must be a number ≥ 0" in str(error), error
else:
    raise AssertionError("a value that is not allowed")

def speed(most):
    # the largest speed of the reference, and the one that F/C allows [m/s]
    changes = {"pilot.guidance": "interactive", "mission.duration": 8.0, name: most}
    mission = tl.load_mission("one-push", changes)
    return np.abs(tl.fly(mission)["reference_velocity"]).max(), most / min(mission.admittance.damping)

free, _ = speed(100.0)
slow, most = speed(0.5)
assert 0.9 * most < slow <= most < 0.5 * free, (free, slow, most)  # M v' + C v = F: below F/C, and near it
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
CHECKS = "def gate_checks("
LAW: Edits = {
    "parts/guidance/admittance.py": [
        (ADMITTANCE, GATE + ADMITTANCE),
        (ANCHORED, SMOOTH + ANCHORED),
        ('Literal["hard", "soft"]', 'Literal["hard", "soft", "smooth"]'),
        (CHOICE, '"smooth": "F³/(F² + threshold²)", ' + CHOICE),
        (
            CHECKS,
            '@plug("gate", "smooth")\ndef _start_smooth(a):\n    return SmoothGate(vec3(a.threshold))\n\n\n' + CHECKS,
        ),
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
        (
            "KINDS = (\n",
            'KINDS = (\n    FindingKind("ends-high", "the vehicle ended above 1 m", "lower `phases.height`"),\n',
        ),
    ],
    "simulation/findings.py": [
        (
            "        *_touches(flight_state),\n",
            "        *_ends_high(flight_state, steps * p.dt),\n        *_touches(flight_state),\n",
        ),
        (
            "def _oscillations(",
            """def _ends_high(flight_state: FlightState, end: float) -> Iterator[Finding]:
    height = flight_state.state.position.z
    if height > 1.0:
        yield finding("ends-high", f"the vehicle ended at {height:.3g} m", time=end, value=height, unit="m", limit=1.0)


def _oscillations(""",
        ),
    ],
}
FINDING_IS_FOUND = """
import tandemlift as tl

def found(height, **more):
    mission = tl.load_mission("hover", {"mission.duration": 12.0, "phases.height": height, **more})
    return [f.kind for f in tl.fly(mission).findings]

assert "ends-high" in found(1.5) and "ends-high" not in found(0.5)
assert "ends-high" not in found(1.5, **{"findings.ignore": ["ends-high"]})
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
    "analysis/studies/metric_descriptions.py": [
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
ENTRY = "    Engine(\n"
ENGINE: Edits = {
    "engines/point.py": [("", BODY)],
    "engines/registry.py": [
        ("class Engine(NamedTuple):", LOADER),
        (ENTRY, '    Engine("point", "A point mass.", _point),\n' + ENTRY),
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

TRIM = '''"""A steady force along body z, on top of the commanded wrench."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal, NamedTuple

from tandemlift.core.errors import CheckResult, judged, refused
from tandemlift.core.findings import Finding, finding
from tandemlift.core.keys import Table, key
from tandemlift.core.law import law
from tandemlift.core.part import FlightCheck, Part, channels_of
from tandemlift.core.types import Number
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.rotors.hover import HoverFacts


class TrimTable(Table, acts=\'trim.model = "steady"\'):
    """`[trim]`: a steady force along body z."""

    model: Literal["none", "steady"] = key("none", None, "the trim", choices={"none": "none", "steady": "a force"})
    force: float = key(0.0, "N", "the force", source="none")


class Trim(NamedTuple):
    """The force [N]."""

    force: Number


class TrimChannels(NamedTuple):
    """The force [N]."""

    trim_force: Number


@law(absent="u")
def trimmed(k: Trim, u: Wrench) -> Wrench:
    """A wrench with the force."""
    return u._replace(thrust=u.thrust + k.force)


@channels_of.register(Trim)
def _channels(k: Trim, memory: Any, decision: Any) -> TrimChannels:
    return TrimChannels(k.force)


def start_trim(table: TrimTable) -> Trim:
    return Trim(table.force)


def trim_refusals(table: TrimTable, guidance: str) -> Iterator[CheckResult]:
    if table.model != "none" and guidance == "interactive":
        yield refused(\'trim.model = "steady": must be "none" where pilot.guidance is "interactive"\')


def trim_checks(table: TrimTable, hover: HoverFacts) -> Iterator[CheckResult]:
    yield judged("trim", abs(table.force), 0.1 * hover.weight, "N", "the trim is large: lower trim.force")


def trim_findings(k: Trim, table: TrimTable, end: float) -> Iterator[Finding]:
    if abs(k.force) > 0.4:
        yield finding("trimmed", f"a trim of {k.force:g} N", time=0.0, duration=end, value=k.force, unit="N")


TRIM = Part(
    *("trim", "pilot", "trim", TrimTable.acts, start_trim),
    remembers=False,
    refusals=trim_refusals,
    checks=trim_checks,
    rows=(FlightCheck("trim", "size of the force", "a tenth of the weight", "N", "", "`trim.force`"),),
    channels=TrimChannels,
    logged="trim",
    findings=trim_findings,
)
'''
LED, TABLE = "    led, lead = lead_step(", "    excitation: ExcitationTable = ExcitationTable()\n"
IMPORT = "from tandemlift.parts.pilot.rotor_lead import "
LAST_GROUP = "    ChannelGroup(\n        'Stamps of readings"
TRIM_CHANNEL = 'ChannelGroup("With a trim", {"trim_force": Channel("N", "body z", "force of the trim", 1)}),\n'
PART: Edits = {
    "parts/pilot/trim.py": [("", TRIM)],
    "parts/pilot/pilot.py": [
        (IMPORT, "from tandemlift.parts.pilot.trim import Trim, trimmed\n" + IMPORT),
        ("    excitation: Excitation | Absent\n", "    excitation: Excitation | Absent\n    trim: Trim | Absent\n"),
        (LED, "    command = command._replace(wrench=trimmed(p.trim, command.wrench))\n" + LED),
    ],
    "missions/mission.py": [
        (IMPORT, "from tandemlift.parts.pilot.trim import TRIM, TrimTable\n" + IMPORT),
        (TABLE, TABLE + "    trim: TrimTable = TrimTable()\n"),
        ("WIND, PERSON),\n", "WIND, PERSON, TRIM),\n"),
    ],
    "flight/channels.py": [(LAST_GROUP, f"    {TRIM_CHANNEL}{LAST_GROUP}")],
    "core/findings.py": [
        ("KINDS = (\n", 'KINDS = (\n    FindingKind("trimmed", "the vehicle had a trim", "lower `trim.force`"),\n'),
    ],
}
PART_FLIES = """
import warnings
import numpy as np
import tandemlift as tl
from reference_tables.checks import checks_at_load
from tandemlift.missions.flight_checks import flight_checks

trim = {"mission.duration": 3.0, "trim.model": "steady", "trim.force": 0.5}
plain, flown = (tl.fly(tl.load_mission("hover", keys)) for keys in ({"mission.duration": 3.0}, trim))
before, after = (f.metrics()["command_at_start"][0] for f in (plain, flown))
np.testing.assert_allclose(after - before, 0.5, rtol=1e-9)
assert (flown["trim_force"] == 0.5).all() and flown.info("trim_force").unit == "N"
assert "trim_force" not in plain.channels
assert [f.kind for f in flown.findings] == [*(f.kind for f in plain.findings), "trimmed"]
assert any(r.check == "trim" and r.verdict == "fails" for r in flight_checks(
    tl.load_mission("hover", {**trim, "trim.force": 20.0})))
assert "| `trim` | size of the force" in checks_at_load()
try:
    tl.load_mission("iris", trim)
except tl.InputError as error:
    assert "trim.model" in str(error), error
else:
    raise AssertionError("a trim with interactive guidance")
"""

RECIPES = {
    "a key touches the file of its table, and of its law where that stands apart": (KEY, KEY_HAS_ITS_EFFECT),
    "a variant of a law touches its law, its key and where it is chosen": (LAW, LAW_FLIES),
    "a sensor that an estimator uses touches its law and the estimator": (SENSOR, SENSOR_IS_USED),
    "a finding touches two files": (FINDING, FINDING_IS_FOUND),
    "a metric touches two files": (METRIC, METRIC_IS_FORMED),
    "the controller of the guide becomes one of the package by an import": (CONTROLLER, CONTROLLER_FLIES),
    "an engine is a class and an entry": (ENGINE, ENGINE_FLIES),
    "an optional part with checks, channels and a finding touches five files": (PART, PART_FLIES),
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


RECIPES_TEXT = (ROOT / "CONTRIBUTING.md").read_text("utf-8").partition("## Recipes\n")[2].partition("\n## ")[0]


def test_the_files_that_the_recipes_name_are_there():
    paths = set(re.findall(r"`([\w/]+\.(?:py|md|ts|toml))`", RECIPES_TEXT.replace("NAME.py", "push.py")))
    folders = (ROOT, PACKAGE, PACKAGE / "pictures" / "report")
    names = {path.name for folder in ("src", "tests", "docs", "web/src") for path in (ROOT / folder).rglob("*.*")}
    there = [any((folder / p).is_file() for folder in folders) or ("/" not in p and p in names) for p in paths]
    assert [path for path, is_there in zip(paths, there, strict=True) if not is_there] == []


def test_the_recipe_of_drag_names_all_files_that_repeat_it():
    repeats = re.compile(r"drag_force \*|\*vehicle\.drag\.force|quadratic_drag\(|drag_coefficient for q in")
    files = {p.relative_to(PACKAGE).as_posix() for p in PACKAGE.rglob("*.py") if repeats.search(p.read_text("utf-8"))}
    assert files == set(re.findall(r"`(\S+\.py)`", RECIPES_TEXT.partition("law of drag**")[2].partition("\n\n**")[0]))
