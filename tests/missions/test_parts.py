"""Parts declare themselves: checks, the start, channels, findings and metrics go over what is declared."""

from __future__ import annotations

import typing
from collections.abc import Iterator

import pytest
from house import PACKAGE

import tandemlift as tl
from tandemlift.core.errors import CheckResult, judged, refused
from tandemlift.core.findings import Finding, finding
from tandemlift.core.part import FlightCheck, Part
from tandemlift.core.vector import Absent, Vec3
from tandemlift.missions.checks import mission_checks
from tandemlift.missions.facts import MADE, Facts
from tandemlift.missions.flight_checks import flight_checks
from tandemlift.missions.mission import PARTS, Mission
from tandemlift.parts.guidance.guidance import PilotTable
from tandemlift.parts.rotors.hover import HoverFacts
from tandemlift.simulation.findings import of_parts
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import metric_names

ASSEMBLED = {"chance", "walk"}  # facts that the assembly of a flight adds
FLOWN = {"k", "m"}  # parameters and memory at the end of a flight


def names_of(function):
    """What a function of a part asks for."""
    code = function.__code__
    return code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]


@pytest.mark.parametrize("part", PARTS, ids=lambda part: f"{part.within}-{part.name}")
def test_a_part_asks_for_what_a_mission_says_and_for_nothing_else(part):
    known = {"table", "started", *MADE, *Mission.model_fields, *(n for n in dir(Mission) if n[0] != "_")}
    before = filter(None, (part.start, part.refusals, part.checks, part.begins))
    after = filter(None, (part.findings, part.metrics))
    assert set().union(*map(names_of, before)) <= known | ASSEMBLED
    assert set().union(*map(names_of, after)) <= known | FLOWN
    assert part.within in ("pilot", "guidance") or not (part.findings or part.metrics), "of_parts does not look there"
    for make in MADE.values():
        assert set(names_of(make)) <= known


@pytest.mark.parametrize("mission", ["paper", "zigzag", "rotor-loss", "gusts"])
def test_what_a_part_asks_for_is_of_the_type_that_it_says(mission):
    facts = Facts(tl.load_mission(mission))
    for part in filter(facts.has, PARTS):
        for function in filter(None, (part.refusals, part.checks, part.start)):
            for name, kind in typing.get_type_hints(function).items():
                plain = typing.get_origin(kind) is None and isinstance(kind, type) and kind is not float
                if plain and name not in {"return", "table", "started"} | ASSEMBLED:
                    assert isinstance(facts[name], kind), (part.name, function.__name__, name)


class GustyChannels(typing.NamedTuple):
    """Six numbers."""

    gust: Vec3
    lull: Vec3


def gusty_refusals(table: PilotTable, step: float) -> Iterator[CheckResult]:
    if step < 0.001:
        yield refused(f"mission.step = {step}: too short for {table.state}")


def gusty_checks(hover: HoverFacts) -> Iterator[CheckResult]:
    yield judged("gusty", hover.weight, 1.0, "N", "too heavy")


def gusty_findings(k: float, end: float) -> Iterator[Finding]:
    yield finding("touched", f"a gust of {k:g} N for {end:g} s", time=end)


GUSTY = Part(
    *("gusty", "pilot", "pilot", 'pilot.guidance = "interactive"', lambda: None),
    remembers=False,
    refusals=gusty_refusals,
    checks=gusty_checks,
    rows=(FlightCheck("gusty", "weight", "1 N", "N", "", "none"),),
    channels=GustyChannels,
    findings=gusty_findings,
    metrics=lambda k: {"gusty_n": k},
)


@pytest.fixture
def declared():
    """A part that is declared in this file alone."""
    PARTS.append(GUSTY)
    yield
    PARTS.remove(GUSTY)


def test_refusals_checks_and_the_size_of_the_log_come_from_the_declaration(declared):
    plain, led = tl.load_mission("hover"), tl.load_mission("iris")
    assert "gusty" in [result.check for result in flight_checks(led)]
    assert "gusty" not in [result.check for result in flight_checks(plain)]
    with pytest.raises(tl.InputError, match=r"mission.step = 0.0005: too short for estimate"):
        tl.load_mission("iris", {"mission.step": 0.0005})
    before = led.sample_size
    PARTS.remove(GUSTY)
    try:
        assert before == led.sample_size + 8 * 6
        assert "gusty" not in [result.check for result in mission_checks(led)]
    finally:
        PARTS.append(GUSTY)


class GustyPilot(typing.NamedTuple):
    """Parameters of a pilot that has the part."""

    guidance: object
    gusty: float


def test_findings_and_metrics_come_from_the_declaration(declared):
    PARTS.remove(GUSTY)
    p, plain = (FlightPlan(tl.load_mission(name)) for name in ("iris", "hover"))
    PARTS.append(GUSTY)
    p.model = p.model._replace(pilot=GustyPilot(p.model.pilot.guidance, 2.0))
    state = p.model.flight_state
    assert [text for found in of_parts(p, state, "findings") for text in map(str, found)] == [
        "touched at 90 s: a gust of 2 N for 90 s"
    ]
    assert [*of_parts(p, state, "metrics")] == [{"gusty_n": 2.0}]
    assert "gusty_n" in metric_names(p)
    assert "gusty_n" not in metric_names(plain)


def test_a_part_that_does_not_act_is_absent_and_one_of_two_variants_takes_their_place():
    for mission in ("paper", "iris"):
        parameters, memory = Facts(tl.load_mission(mission)).started("pilot")
        assert parameters["excitation"] == Absent()
        assert (memory["lead"] == Absent()) == (parameters["lead"] == Absent()) == (mission == "paper")
        assert type(parameters["guidance"]).__name__ == {"paper": "ScheduledGuidance", "iris": "HandGuidance"}[mission]


OPTIONAL = {
    "parts.pilot.excitation": "excitation",
    "parts.pilot.rotor_lead": "lead",
    "parts.guidance.energy_tank": "tank",
    "parts.guidance.policy": "policy",
}


@pytest.mark.parametrize("module", OPTIONAL)
def test_few_files_of_the_package_know_an_optional_part(module):
    """Its own, the one in whose step it acts, and the mission; at most five, so that no list of parts creeps back."""
    name = f"from tandemlift.{module} import"
    knows = [path for path in PACKAGE.rglob("*.py") if name in path.read_text("utf-8")]
    nucleus = ("core", "compiler", "flight", "missions", "engines", "simulation")
    outside = [path.relative_to(PACKAGE).as_posix() for path in knows if path.relative_to(PACKAGE).parts[0] in nucleus]
    assert len(knows) <= 4, [path.name for path in knows]
    assert set(outside) <= {"missions/mission.py"}
