"""Faults, checks and phases are said once: what is derived from their records, and the recipe for one more of them."""

import subprocess
import sys
from typing import get_args

from for_all import for_all

from tandemlift.core.faults import ALARM_TEXTS, CHECKS, FAULTS, REACTION_MEANINGS, REACTIONS, Reaction
from tandemlift.flight.channels import CHANNELS
from tandemlift.parts.guidance.fault_detection import ActiveFaults, strongest_reaction
from tandemlift.parts.guidance.preflight_checks import first_failed
from tandemlift.parts.guidance.supervision import SupervisionTable

NONE = ActiveFaults(*[0.0] * len(FAULTS))


def test_faults_and_checks_have_names_and_numbers_of_their_own():
    for records in (FAULTS, CHECKS):
        assert sorted(r.number for r in records) == list(range(1, len(records) + 1))
    assert len({fault.key for fault in FAULTS}) == len({fault.text for fault in FAULTS}) == len(FAULTS)
    assert len({(check.before, check.key) for check in CHECKS}) == len(CHECKS)


def test_alarms_and_phases_of_recorded_flights_keep_their_numbers():
    texts = {0: "", 10: "imu stale", 41: "gyroscope frozen", 62: "position not a number", 190: "rotor failed"}
    assert {number: ALARM_TEXTS[number] for number in texts} == texts
    numbers = {5: "motion", 12: "state", 13: "orientation", 20: "speed_inconsistent"}
    assert {fault.number: fault.key for fault in FAULTS if fault.number in numbers} == numbers
    assert CHANNELS["phase"].meaning == "0 idle, 1 lift, 2 guided, 3 land, 4 hold, 5 stopped, 6 contact, 7 limited"


def test_every_fault_has_a_reaction_key_with_its_default():
    assert dict(SupervisionTable().reactions) == {fault.key: fault.reaction for fault in FAULTS}
    assert set(REACTION_MEANINGS) == set(get_args(Reaction)) == set(REACTIONS)


@for_all(FAULTS, lambda fault: fault.key)
def test_the_reaction_to_a_fault_is_that_of_its_key_and_the_alarm_is_its_number(fault):
    symptom = float(len(fault.symptoms))
    present = NONE._replace(**{fault.key: symptom or 1.0})
    found = strongest_reaction(present, NONE._replace(**{fault.key: 2.0}))
    assert found == (2.0, 10.0 * fault.number + symptom)
    assert strongest_reaction(present, NONE) == (0.0, 0.0)  # its reaction is "none"
    assert strongest_reaction(NONE, NONE._replace(**{fault.key: 2.0})) == (0.0, 0.0)


def test_of_all_faults_the_first_with_the_strongest_reaction_gives_the_alarm():
    every = ActiveFaults(*[1.0] * len(FAULTS))
    for i, fault in enumerate(FAULTS):
        reactions = {f.key: 1.0 if j < i else 2.0 for j, f in enumerate(FAULTS)}
        found = strongest_reaction(every, ActiveFaults(**reactions))
        assert found == (2.0, 10.0 * fault.number + bool(fault.symptoms))


def test_the_first_check_that_fails_is_reported():
    for before in ("lift", "guided"):
        checks = [check for check in CHECKS if check.before == before]
        for i, check in enumerate(checks):
            fails = {c.key: float(j >= i) for j, c in enumerate(checks)}
            assert first_failed(before, fails) == check.number
        assert first_failed(before, {c.key: 0.0 for c in checks}) == 0.0


RECIPE = """
from tandemlift.core import faults
NEXT = len(faults.FAULTS) + 1
new = faults.Fault(NEXT, "battery", "battery low", "the battery is low", "stop", "below a voltage")
faults.FAULTS = (*faults.FAULTS, new)
faults.ALARM_TEXTS = faults._alarm_texts()

import tandemlift as tl
from tandemlift.parts.guidance.fault_detection import ActiveFaults, strongest_reaction
from tandemlift.missions.reference import explained
from tandemlift.apps.live.session.scene_builder import scene_of

mission = tl.load_mission("iris", {"pilot.guidance": "interactive", "supervision.model": "on",
                                   "supervision.reactions.battery": "land"})
assert mission.supervision.reactions.battery == "land"
assert "reaction when the battery is low" in explained("supervision.reactions.battery")
assert scene_of(mission, "compiled")["alarms"][10 * NEXT] == "battery low"
none = ActiveFaults(*[0.0] * len(faults.FAULTS))
assert strongest_reaction(none._replace(battery=1.0), none._replace(battery=3.0)) == (3.0, 10.0 * NEXT)
from tandemlift.simulation.results import describe_event
assert describe_event((3, 10 * NEXT, 0, 0), (2, 0, 0, 0)) == "battery low -> land"
try:
    tl.fly(mission)
except TypeError as error:
    assert "battery" in str(error), error  # no law detects it yet
else:
    raise AssertionError("a fault that no law detects has flown")
"""


def test_a_fault_that_is_added_as_contributing_says_gets_its_key_its_alarm_its_text_and_its_place():
    done = subprocess.run([sys.executable, "-c", RECIPE], capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
