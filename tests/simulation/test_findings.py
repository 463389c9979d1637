"""Each kind of finding in a flight that has it and in one that has not, against NumPy and SciPy on all of its steps."""

import math
import warnings

import numpy as np
import pytest
from scipy.fft import rfft, rfftfreq
from scipy.signal import find_peaks

import tandemlift as tl
from tandemlift.missions.outcomes import promise_of
from tandemlift.parts.guidance.supervision import SLOTS
from tandemlift.simulation.findings import findings_of
from tandemlift.simulation.plan import FlightPlan

ROTORS = {"actuators.model": "rotors", "mission.duration": 14.0, "mission.log_interval": 0.001}
CLOCK = {  # on top of mission hover with rotors, in one compiled loop
    "calm": {},
    "slow rotors": {"initial.euler": [0.1, 0.1, 0.0], "actuators.delay": 0.06},
    "steep lift": {"phases.lift_start": 11.0, "phases.lift_duration": 0.5},
    "weight": {"disturbance.force": [0.0, 0.0, -21.5]},
    "held up": {"phases.land_start": 6.0, "phases.land_duration": 4.0, "disturbance.force": [0.0, 0.0, 34.5]},
    "sideways": {
        "disturbance.force": [3.0, 0.0, 0.0],
        "promise.distance": 0.3,
        "promise.settling_time": 2.0,
        "promise.tilt": 0.05,
    },
    "sinking": {"disturbance.force": [0.0, 0.0, -8.0], "promise.sinking": 0.05, "promise.settling_time": 2.0},
    "turned": {"disturbance.moment": [0.0, 0.0, 0.1], "promise.heading": 0.01},
}
HAND = {  # on top of mission iris
    "answered": {},
    "unanswered": {"compliance.thrust_fraction": 0.5},
}


@pytest.fixture(scope="module")
def flights():
    """Flights by name, as a block where they are of one variant."""
    delay = {"actuators.delay": 0.001}  # so that all have a delay line
    clock = [tl.load_mission("hover", {**ROTORS, **delay, **changes}) for changes in CLOCK.values()]
    hand = {"mission.duration": 26.0, "mission.log_interval": 0.001}
    iris = [tl.load_mission("iris", {**hand, **changes}) for changes in HAND.values()]
    return dict(zip([*CLOCK, *HAND], tl.fly_many([*clock, *iris]), strict=True))


def of_kind(flight, kind, quantity=""):
    return [f for f in flight.findings if f.kind == kind and f.quantity.startswith(quantity)]


def only(flight, kind, quantity=""):
    (found,) = of_kind(flight, kind, quantity)
    return found


def distance(flight):
    return np.linalg.norm(flight["position_error"], axis=1)


def stretches(over):
    """Starts and lengths, in samples, of all stretches of a mask."""
    ends = np.flatnonzero(np.diff(np.concatenate(([0], over.astype(int), [0]))))
    return ends[::2], ends[1::2] - ends[::2]


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["calm", "answered"])
def test_a_flight_that_goes_well_has_no_findings(flights, name):
    assert flights[name].findings == ()
    assert flights[name].metrics()["findings"] == []


def test_an_oscillation_has_the_frequency_and_amplitude_of_its_channel(flights):
    flight = flights["slow rotors"]
    found = only(flight, "oscillating", "pitch rate")
    part = (flight.time >= found.time) & (flight.time < found.time + found.duration)
    rate = flight["rates"][part, 1]
    spectrum = np.abs(rfft(rate * np.hanning(len(rate))))
    frequency = rfftfreq(len(rate), 0.001)[spectrum.argmax()]
    assert float(found.quantity.split()[-2]) == pytest.approx(frequency, abs=1.0 / found.duration)
    peaks = np.abs(rate[find_peaks(np.abs(rate), distance=round(300 / frequency))[0]])
    assert found.value == pytest.approx(np.median(peaks[-8:]), rel=0.15)
    assert found.limit == 0.3


def test_the_distance_and_its_root_mean_square_are_those_of_the_channels(flights):
    flight = flights["sideways"]
    d, t = distance(flight)[:-1], flight.time[:-1]  # the last sample has no step
    found, late = only(flight, "off-track", "distance"), t >= 2.0
    assert found.value == pytest.approx(d[late].max(), rel=1e-12)
    starts, lengths = stretches(late & (d > 0.3))
    assert found.duration == pytest.approx(lengths.sum() * 1e-3)
    assert found.time == pytest.approx(t[starts[lengths.argmax()]])
    assert found.place == pytest.approx(flight["position"][np.where(late, d, 0.0).argmax()])
    rms = only(flight, "off-track", "RMS")
    assert rms.value == pytest.approx(math.sqrt(np.mean(d[late] ** 2)), rel=1e-12)


def test_sinking_is_how_far_the_channels_are_below_the_reference(flights):
    flight = flights["sinking"]
    late = flight.time[:-1] >= 2.0
    below = (flight["reference_position"] - flight["position"])[:-1, 2]
    found = only(flight, "off-track", "sinking")
    assert found.value == pytest.approx(below[late].max(), rel=1e-12)
    assert found.duration == pytest.approx((late & (below > 0.05)).sum() * 1e-3)
    assert not of_kind(flight, "off-track", "distance")
    assert not of_kind(flights["sideways"], "off-track", "sinking")


def test_a_person_is_promised_that_the_vehicle_does_not_sink():
    promise = tl.load_mission("iris").promise
    assert promise_of(promise, "interactive").sinking == 0.1
    assert promise_of(promise, "scheduled").sinking == math.inf


def test_heading_and_tilt_are_those_of_the_channels(flights):
    flight = flights["turned"]
    late = (flight.time >= 10.0) & (flight.time < 14.0)
    assert only(flight, "off-track", "difference").value == pytest.approx(
        np.abs(flight["attitude_error"][late, 2]).max(), rel=1e-9
    )
    leaning = flights["sideways"]
    _, x, y, _ = leaning["attitude"][(leaning.time >= 2.0) & (leaning.time < 14.0)].T
    assert only(leaning, "off-track", "tilt").value == pytest.approx(np.arccos(1.0 - 2.0 * (x * x + y * y)).max())
    assert not of_kind(flight, "off-track", "tilt")


def test_saturation_is_that_of_the_commands(flights):
    flight = flights["weight"]
    commands, most = flight["rotor_commands"][:-1], 5.84e-6 * 1100.0**2
    _, lengths = stretches(((commands <= 0.0) | (commands >= most)).any(axis=1))
    found = only(flight, "saturated")
    assert found.value == pytest.approx(lengths.max() * 1e-3, abs=1e-9)
    assert found.duration == pytest.approx(lengths.sum() * 1e-3, abs=1e-9)
    assert flight.metrics()["rotor_saturated_share"] == pytest.approx(lengths.sum() / len(commands))
    assert not of_kind(flights["steep lift"], "oscillating")


def test_a_reference_out_of_reach_asks_for_more_thrust_than_there_is(flights):
    flight = flights["steep lift"]
    found = only(flight, "out-of-reach", "thrust")
    needed = 3.5 * np.linalg.norm(flight["reference_acceleration"] + [0.0, 0.0, 9.81], axis=1)
    most = 8 * 5.84e-6 * 1100.0**2
    assert found.limit == pytest.approx(most)
    assert found.value == pytest.approx(needed.max(), rel=1e-3)
    assert found.duration == pytest.approx((needed > most).sum() * 1e-3, abs=0.002)
    left = only(flights["held up"], "out-of-reach", "distance")
    assert left.value == pytest.approx(distance(flights["held up"])[:-1].max(), rel=1e-12)


def test_a_push_that_moves_nothing_is_found(flights):
    flight = flights["unanswered"]
    found = of_kind(flight, "no-response-to-push")
    assert found
    gated, true = flight["admittance_force"], flight["push_force"]
    gated, true = (np.linalg.norm(f, axis=1) for f in (gated, true - np.clip(true, -0.6, 0.6)))
    force = np.where(gated > 0.03, gated, true)  # a true push should be heard from twice the threshold on
    part = (flight.time >= found[0].time) & (flight.time <= found[0].time + found[0].duration)
    assert found[0].value == pytest.approx(force[part].max(), rel=0.02)
    assert np.abs(flight["velocity"][part][:, :2]).max() < 0.1  # 1 N would lead to 0.6 m/s
    assert np.linalg.norm(flights["answered"]["velocity"][part], axis=1).max() > 0.5


def test_a_vehicle_that_stays_in_the_air_has_not_landed(flights):
    found = only(flights["held up"], "not-landed")
    assert found.time == 14.0
    assert found.value == pytest.approx(flights["held up"]["position"][-1, 2])
    assert flights["held up"].outcome == "flying"
    assert not of_kind(flights["calm"], "not-landed")


def test_the_first_of_several_landings_that_are_asked_for_is_the_one_that_is_missed_however_high_it_has_climbed():
    asked = [{"action": "land", "time": t} for t in (20.0, 5.0, 60.0)]
    plan = FlightPlan(tl.load_mission("iris", {"requests": asked, "mission.duration": 70.0}))
    start = plan.model.flight_state

    def missed(seconds, outcome="flying", height=0.5):
        above = start.state._replace(position=start.state.position._replace(z=start.state.position.z + height))
        found = findings_of(plan, start._replace(state=above), round(seconds / plan.dt), outcome)
        return [(f.kind, f.value, f.text.split()[-2]) for f in found]

    assert missed(19.0) == [("not-landed", pytest.approx(0.5), "5")]
    assert missed(19.0, height=100.0) == [("not-landed", pytest.approx(100.0), "5")]  # no time to sink from there
    assert missed(69.0) == missed(19.0)
    assert missed(6.0) == missed(19.0, "landed") == []


def test_ignored_kinds_are_left_out(flights):
    changes = {**ROTORS, "actuators.delay": 0.001, **CLOCK["sideways"], "findings.ignore": ["off-track"]}
    assert tl.fly(tl.load_mission("hover", changes)).findings == ()


WATCHED = {
    "mission.duration": 12.0,
    "phases.lift_start": 0.5,
    "phases.lift_duration": 2.0,
    "phases.land_start": 7.0,
    "phases.land_duration": 3.0,
    "compliance.max_descent_speed": 0.8,  # m/s: lands in 3 s
    "supervision.model": "on",
    "sensor_faults": [{"sensor": "position", "kind": "bias", "time": 1000.0}],  # none, in the same compiled loop
}
LATE = {"phases.land_start": 1000.0}
FAILING = {"sensor_faults": [{"sensor": "gyroscope", "kind": "frozen", "time": 6.0}]}


@pytest.fixture(scope="module")
def fly():
    return lambda changes: tl.fly(tl.load_mission("iris", {**WATCHED, **changes}))


def kinds(flight):
    return [f.kind for f in flight.findings]


def test_a_landing_that_nobody_asked_for_has_the_fault_as_its_reason(fly):
    found = fly({**LATE, **FAILING}).findings
    assert [f.kind for f in found if f.kind != "saturated"] == ["landed-by-fault"]  # without a gyroscope it swings
    assert found[0].quantity == "gyroscope frozen"
    assert 6.0 < found[0].time < 6.3


def test_a_landing_that_was_asked_for_is_none(fly):
    flight = fly({})
    assert flight.outcome == "landed"
    assert kinds(flight) == []


def test_a_refused_lift_says_which_check_failed(fly):
    flight = fly({"supervision.checks.thrust_fraction": 0.3})
    assert flight.outcome == "not-lifted"
    (found,) = [f for f in flight.findings if f.kind == "lift-refused"]
    assert found.quantity == "hover not feasible"
    assert found.time == pytest.approx(0.5, abs=0.01)


def test_a_rotor_that_failed_is_the_reason_of_a_landing_without_supervision():
    flight = tl.fly(tl.load_mission("rotor-loss", {"mission.duration": 18.0, "mission.log_interval": 0.001}))
    assert kinds(flight) == ["landed-by-fault"]
    assert "rotor 1" in flight.findings[0].text
    assert 14.0 < flight.findings[0].time < 14.5
    commands, most = flight["rotor_commands"][:-1], 5.84e-6 * 1100.0**2
    usable = np.arange(1.0, 9.0) != flight["failed_rotor"][:-1, None]  # one known as failed does not count
    limited = (((commands <= 0.0) | (commands >= most)) & usable).any(axis=1) & (flight["phase"][:-1] > 0.0)
    assert flight.metrics()["rotor_saturated_share"] == pytest.approx(limited.mean(), rel=1e-12)


def test_a_landing_by_fault_is_found_after_more_events_than_are_kept():
    requests = [{"time": 12.5 + 0.5 * i, "action": ("disable", "enable")[i % 2]} for i in range(18)]
    fault = {"sensor": "accelerometer", "kind": "nan", "time": 22.0}
    changes = {"supervision.model": "on", "pushes": [], "phases.land_start": 1e6, "requests": requests}
    flight = tl.fly(tl.load_mission("iris", {**changes, "sensor_faults": [fault], "mission.duration": 23.0}))
    assert kinds(flight) == ["landed-by-fault"]
    times = [time for time, _ in flight.metrics()["events"]]
    assert len(times) == SLOTS
    assert times == sorted(times)


def test_a_landing_by_fault_is_found_while_the_supervision_also_notes_a_contact():
    p = FlightPlan(tl.load_mission("iris", {"supervision.model": "on"}))
    state = p.model.flight_state
    guidance = state.memory.guidance
    log = guidance.supervision.events
    contact, land, tilted = 1e8, 3e6, 160e2  # factors in the code of an event: a contact, phase "land", alarm 160
    codes = [contact + land + tilted, *log.code[1:]]
    events = log._replace(time=type(log.time)(2.5, *log.time[1:]), code=type(log.code)(*codes), count=1.0)
    guidance = guidance._replace(supervision=guidance.supervision._replace(events=events))
    state = state._replace(memory=state.memory._replace(guidance=guidance))
    (found,) = [f for f in findings_of(p, state, 1, "flying") if f.kind == "landed-by-fault"]
    assert (found.time, found.text) == (2.5, "landed because of a fault: tilted too far")


@pytest.mark.thorough
def test_a_push_into_a_wall_without_response_names_the_wall():
    walls = [{"start": [20.0, -3.0], "end": [20.0, 3.0]}, {"start": [1.2, -3.0], "end": [1.2, 3.0]}]
    push = [{"force": [4.0, 0.0, 0.0], "time": 20.0, "sigma": 3.0}]
    times = {"mission.duration": 32.0, "phases.land_start": None}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tl.FlightWarning)
        flight = tl.fly(tl.load_mission("iris", {"walls": walls, "pushes": push, **times}))
    text = next(finding.text for finding in flight.findings if finding.kind == "no-response-to-push")
    assert "walls.1 is in the way of the guard of quadrotor" in text
