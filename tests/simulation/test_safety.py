"""docs/reference/faults.md is what happens: every row of its table of faults is flown, in one compiled loop."""

import re

import numpy as np
import pytest
from reference_tables.faults import fault_rows
from repository import ROOT

import tandemlift as tl
from tandemlift.core.faults import ALARM_TEXTS
from tandemlift.core.phases import PHASE_NAMES
from tandemlift.core.vector import ZERO, Absent
from tandemlift.missions.key_descriptions import sections
from tandemlift.parts.guidance.disturbance_observer import NONE
from tandemlift.parts.guidance.guidance import PilotInput, checked_input, guide
from tandemlift.parts.guidance.requests import NO_REQUEST, UNKNOWN_STATUS
from tandemlift.simulation.preparation.assemble import assemble

AT, STANDS = 8.5, 0.03  # s, when sensors fail; m, height of the standing vehicle
QUIET = [{"sensor": "position", "kind": "bias", "time": 1000.0}]  # no fault, in the same compiled loop
FLOWN = {
    "mission": {"duration": 21.0, "log_interval": 0.02},
    "pilot": {"guidance": "interactive", "state": "estimate", "push": "estimate"},
    "phases": {"lift_start": 0.5, "lift_duration": 2.0, "height": 1.0, "land_start": 1000.0, "land_duration": 3.0},
    "estimator": {"tare": "hover", "tare_duration": 1.0},
    "pushes": [{"force": [2.0, 0.0, 0.0], "time": 7.0, "sigma": 0.4}],
    "requests": [{"time": 1000.0, "action": "land"}],
    "supervision.model": "on",
    "contact.model": "on",
    "crash.impulse": 100.0,  # a fall is what a reaction may be
    "sensor_faults": QUIET,
}


def failed(sensor, kind, **more):
    """A sensor's fault from the set time on."""
    return {"sensor": sensor, "kind": kind, "time": AT, **more}


def sensors(*faults):
    """The change of a mission in which these sensors fail."""
    return {"sensor_faults": list(faults)}


SENSORS = ("joints", "accelerometer", "gyroscope", "position", "velocity", "attitude")
TOO_MUCH = dict(zip(SENSORS, (200.0, 100.0, 20.0, 200.0, 30.0, 1.0), strict=True))  # beyond the range of each
TRIED_WITH = {  # each fault by its text, and the changes of the mission that lead to it
    "attitude and gyroscope lost": sensors(failed("attitude", "nan"), failed("gyroscope", "nan")),
    "imu stale": sensors(failed("imu", "stale")),
    "motion stale": sensors(failed("motion", "stale")),
    **{f"{sensor} frozen": sensors(failed(sensor, "frozen")) for sensor in TOO_MUCH},
    **{f"{sensor} not a number": sensors(failed(sensor, "nan")) for sensor in TOO_MUCH},
    **{
        f"{sensor} out of range": sensors(failed(sensor, "range", size=[size] * 3)) for sensor, size in TOO_MUCH.items()
    },
    "joints disagree": sensors(failed("joints", "bias", quadrotor=1, size=[5, 0, 0])),
    "attitude disagrees with gyroscope": sensors(failed("gyroscope", "bias", size=[0.4, 0, 0])),
    "velocity disagrees with position": sensors(failed("velocity", "bias", size=[0.25, 0, 0])),
    "accelerometer disagrees with velocity": sensors(failed("accelerometer", "bias", size=[1.0, 0, 0])),
    "tilted too far": {"supervision.limits.tilt": 0.02, "supervision.limits.tilt_time": 0.0},
    "turning too fast": {"supervision.limits.rates": 0.05, "supervision.limits.rates_time": 0.0},
    "outside the fence": {"supervision.fence.low": [-1000.0, -1000.0, 1.5], "crash.fence_margin": 10.0},
    "too little thrust left": {"supervision.limits.thrust_fraction": 0.5},
    "too far from the reference": {
        "supervision.limits.tracking_error": 0.002,
        "supervision.limits.tracking_error_time": 0.0,
    },
    "cannot follow: no thrust left": {
        "compliance.thrust_fraction": 0.62,
        "admittance.threshold": 3.0,
        "pushes": [{"force": [0, 0, -1.5], "time": 7, "sigma": 0.8}],
        "supervision.hold_timeout": 0.2,
    },
    "cannot follow: pushed aside too hard": {
        "compliance.max_tilt": 0.05,
        "compliance.following.time": 0.1,
        "supervision.hold_timeout": 0.2,
    },
    "cannot follow: heading lost": {
        "compliance.yaw.max_lead_angle": 0.003,
        "compliance.following.time": 0.02,
        "supervision.hold_timeout": 0.2,
    },
    "cannot follow: too far from the reference": {
        "controller.human_force_feedforward": False,
        "compliance.following.max_error": 0.05,
        "supervision.hold_timeout": 0.2,
    },
}
IN_PLAIN_PYTHON = {"state not a number", "rotor failed"}  # flown below
ROWS = tuple(fault_rows())


@pytest.fixture(scope="module")
def fly():
    """Flies the mission with changes."""
    return lambda changes: tl.fly(tl.load_mission("iris", {**FLOWN, **changes}))


def test_every_fault_of_the_table_is_flown():
    assert {row.text for row in ROWS} == TRIED_WITH.keys() | IN_PLAIN_PYTHON


@pytest.mark.thorough
@pytest.mark.parametrize("row", [row for row in ROWS if row.text in TRIED_WITH], ids=lambda row: row.text)
def test_every_fault_has_the_reaction_of_the_table_and_ends_safely(row, fly):
    fault, reaction = row.text, row.reaction
    flight = fly(TRIED_WITH[fault])
    events = [what for _, what in flight.metrics()["events"]]
    held = "limited" if fault.startswith("cannot follow") else "hold"
    entered = {"hold": held, "land": "land", "stop": "stopped"}[reaction]
    assert f"{fault} -> {entered}" in events, events
    assert {int(a) // 10 for a in flight["alarm"]} - {0} == {row.number}
    assert flight.ending is None
    assert PHASE_NAMES[int(flight["phase"][-1])] == ("stopped" if reaction == "stop" else "idle"), events
    assert not flight["contact_part"].any()
    assert flight["rotor_thrusts"][-1].max() < 1e-6
    assert flight["position"][-1, 2] == pytest.approx(STANDS, abs=0.02)
    assert np.abs(flight["euler"][-1, :2]).max() < 0.02
    if reaction != "stop":
        assert flight["velocity"][flight["phase"] == 3.0, 2].min() > -0.4  # the landing's 0.3 m/s, and noise
        assert flight["velocity"][:, 2].min() > -0.8  # from where its rotors stop, 3 cm at most
        assert np.abs(flight["euler"][:, :2]).max() < 0.22
    if reaction == "hold":
        assert f"{fault} -> land" in events, events  # after its patience


def test_without_a_fault_nothing_alarms_and_it_listens(fly):
    flight = fly({})
    assert flight.metrics()["events"] == [
        [0.5, "lift"],
        [2.8, "hold: no tare yet"],
        [pytest.approx(4.8, abs=0.1), "guided"],
    ]
    assert flight["position"][-1, 0] > 0.5  # it went where it was pushed


def test_a_sensor_that_comes_back_ends_the_hold(fly):
    flight = fly({"sensor_faults": [{"sensor": "joints", "kind": "nan", "time": AT, "until": AT + 1.0}]})
    assert [w for _, w in flight.metrics()["events"]][-2:] == ["joints not a number -> hold", "guided"]


def test_knowing_nothing_of_its_motion_it_comes_down_level_and_gently(fly):
    lost = [{"sensor": "motion", "kind": "stale", "time": AT}, {"sensor": "accelerometer", "kind": "nan", "time": AT}]
    flight = fly({"sensor_faults": lost})
    assert flight["velocity"][:, 2].min() > -1.2
    assert flight["position"][-1, 2] == pytest.approx(STANDS, abs=0.02)
    assert np.abs(flight["euler"][:, :2]).max() < 0.2


def test_the_reference_and_the_vehicle_stay_inside_the_fence(fly):
    flight = fly({"supervision.fence.high": [0.4, 1000.0, 1000.0]})
    assert flight["reference_position"][:, 0].max() < 0.4
    assert flight["reference_position"][-1, 0] > 0.3
    assert not flight["alarm"].any()


def test_after_a_landing_a_push_is_neither_heard_nor_countered(fly):
    push = [{"force": [2.0, 0.0, 0.0], "time": t, "sigma": 0.4} for t in (7.0, 19.0)]
    flight = fly({"requests": [{"time": AT, "action": "land"}], "pushes": push})
    down = flight["phase"] == 0.0
    landed = down & (flight.time > 10.0)
    assert landed.any()
    assert not flight["admittance_force"][landed & (flight.time > 17.0)].any()
    assert not flight["push_active"][landed].any()


def in_plain_python(seconds, heard_at):
    """Names of the phases of a guidance by hand that is told a state at rest, and what `heard_at` makes of it."""
    far = {"supervision.limits.tracking_error": 100.0, "compliance.following.max_error": 100.0}
    changes = {**FLOWN, **far}  # the state at rest does not follow the lift
    model = assemble(tl.load_mission("iris", changes)).model
    guidance, memory, dt, names = model.pilot.guidance, model.flight_state.memory.guidance, 0.01, []
    for i in range(round(seconds / dt)):
        pilot_input = PilotInput(model.flight_state.state, ZERO, ZERO, 0.0, Absent(), NO_REQUEST, UNKNOWN_STATUS)
        pilot_input, lost = heard_at(pilot_input, i * dt)
        pilot_input = checked_input(guidance, memory, pilot_input, 0.0, lost)
        decided, memory = guide(guidance, memory, pilot_input, NONE, lost, i * dt, dt)
        names.append(PHASE_NAMES[int(decided.channels.phase)])
    return list(dict.fromkeys(names)), memory


def test_a_rotor_that_is_found_lost_lands_the_vehicle():
    names, memory = in_plain_python(5.0, lambda pilot_input, t: (pilot_input, float(t > 4.0)))
    assert names == ["idle", "lift", "guided", "land"]
    assert ALARM_TEXTS[int(memory.supervision.alarm)] == "rotor failed"


def test_a_rotor_that_is_lost_on_the_ground_refuses_the_lift():
    names, _ = in_plain_python(2.0, lambda pilot_input, t: (pilot_input, 1.0))
    assert names == ["idle"]


@pytest.mark.parametrize(
    ("last", "names"), [(0.04, ["idle", "lift", "guided"]), (1.0, ["idle", "lift", "guided", "stopped"])]
)
def test_a_state_without_numbers_is_bridged_for_a_moment_and_then_stops(last, names):
    def heard_at(pilot_input, t):
        blank = pilot_input.state._replace(position=ZERO * float("nan"))
        return (
            pilot_input._replace(state=blank, push=ZERO * float("nan")) if 4.0 <= t < 4.0 + last else pilot_input
        ), 0.0

    found, memory = in_plain_python(5.5, heard_at)
    assert found == names
    assert np.isfinite([*memory.compliance.position, *memory.compliance.filtered.value]).all()


def test_every_key_that_the_document_names_is_one():
    text = (ROOT / "docs" / "explanation" / "safety.md").read_text("utf-8")
    known = {key.name for section in sections() for key in section.keys}
    tables = {section.name for section in sections()}
    named = re.findall(r"`((?:supervision|compliance|contact|estimator|crash)\.[a-z_.]+)`", text)
    assert len(named) > 10
    assert [key for key in named if key not in known | tables] == []
