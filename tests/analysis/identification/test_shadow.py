"""The shadow of our own flight decides as the flight did, to the last bit; that of another one feels the difference."""

from dataclasses import replace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.logs.log import COMMANDS, MOTION, SPEED_COMMANDS, Log, Stream, log_of
from tandemlift.flight.channels import FLOWN

OF_THE_PILOT = (
    *("rotor_commands", "thrust", "moment", "reference_position", "reference_euler", "admittance_position", "phase"),
    *("push_estimate", "push_moment_estimate", "push_withheld", "estimated_attitude", "disturbance_force"),
    *("measured_position", "measured_specific_force", "measured_joint_torque", "payload_mass_estimate"),
)
SLOW = {
    "sensors.delay": 0.002,
    "sensors.interval": 0.002,
    "sensors.joints.interval": 0.004,
    "sensors.motion.delay": 0.007,
    "sensors.motion.first_sample": 0.003,
}
SOON_PUSHED = {
    "mission.duration": 6.0,
    "phases.lift_start": 0.5,
    "phases.lift_duration": 2.0,
    "phases.land_start": None,
    "estimator.tare_start": 3.0,
    "estimator.tare_duration": 1.0,
    "pushes": [{"force": [3.0, 0.0, 0.0], "time": 5.0, "sigma": 0.3}],
}
JOINTS_OF = {"fused": "simulated"}


def iris(**changes):
    full = {"mission.duration": 25.0, "mission.log_interval": 0.001}
    return tl.load_mission("iris", full | changes)


@pytest.fixture(scope="module")
def flown():
    """A flight with a lift, its tare, and a push up and one along x."""
    return tl.fly(iris())


@pytest.fixture(scope="module")
def log(flown):
    return log_of(flown)


def without(log, *names):
    return replace(log, streams={name: stream for name, stream in log.streams.items() if name not in names})


def same_bits(flight, shadow, names=OF_THE_PILOT):
    count = len(shadow.time)
    assert count > 0.99 * len(flight.time)
    different = [name for name in names if flight[name][:count].tobytes() != shadow[name].tobytes()]
    assert not different


def test_the_shadow_of_our_own_flight_decides_to_the_last_bit(flown, log):
    shadow = tl.shadow(log, iris())
    same_bits(flown, shadow)
    assert np.abs(shadow["push_estimate"]).max() > 2.0
    assert np.array_equal(shadow["rotor_commands"], shadow[FLOWN])
    assert shadow.findings == tuple(f for f in flown.findings if f.time <= shadow.time[-1])


@pytest.mark.thorough
def test_it_does_so_with_slow_and_late_sensors_and_whatever_the_log_interval_of_the_shadow():
    flight = tl.fly(iris(**{"mission.duration": 6.0, **SLOW}))
    shadow = tl.shadow(log_of(flight), iris(**{"mission.log_interval": 0.01, **SLOW}))
    count = len(shadow.time)
    assert np.array_equal(shadow["rotor_commands"], flight["rotor_commands"][::10][:count])
    assert np.array_equal(shadow["measured_joint_force"], flight["measured_joint_force"][::10][:count])


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "engine", "duration"), [("iris", "mujoco", 6.0), ("rotor-loss", "compiled", 17.0)])
def test_it_does_so_whatever_engine_flew_and_where_a_rotor_fails(name, engine, duration):
    if engine == "mujoco":
        pytest.importorskip("mujoco")
    mission = tl.load_mission(name, {"mission.duration": duration, "mission.log_interval": 0.001})
    flight = tl.fly(mission, engine)
    same_bits(flight, tl.shadow(log_of(flight), mission), OF_THE_PILOT[:-1])


@pytest.mark.thorough
@pytest.mark.parametrize("wrench", ["momentum", "fused"])
def test_an_observer_finds_in_the_log_what_it_found_in_flight(wrench):
    """It weighs the samples by the noise that the mission tells of, not by that of the shadow's exact sensors."""
    mission = iris(**SOON_PUSHED, **{"estimator.wrench": wrench, "sensors.joints.model": JOINTS_OF.get(wrench, "none")})
    flight = tl.fly(mission)
    shadow = tl.shadow(log_of(flight), mission)
    same_bits(flight, shadow, OF_THE_PILOT[:-2])
    assert np.abs(shadow["push_estimate"]).max() > 2.0


def test_without_commands_the_pilot_takes_its_own_for_flown(flown, log):
    shadow = tl.shadow(without(log, COMMANDS, SPEED_COMMANDS, "push_force").between(-1.0, 8.0), iris())
    assert np.array_equal(shadow["rotor_commands"], flown["rotor_commands"][: len(shadow.time)])
    assert FLOWN not in shadow


def test_speeds_are_turned_into_thrusts_by_the_mission(log):
    shadow = tl.shadow(without(log, COMMANDS).between(-1.0, 8.0), iris())
    assert np.abs(shadow["rotor_commands"] - shadow[FLOWN]).max() < 1e-9


def test_a_vehicle_that_flew_with_less_thrust_than_its_pilot_believes_feels_lifted(flown, log):
    share, weight = 0.03, flown.vehicle.weight
    weaker = Stream(log[COMMANDS].time, (1.0 - share) * log[COMMANDS].values)
    shadow = tl.shadow(replace(log, streams={**log.streams, COMMANDS: weaker}).between(-1.0, 14.0), iris())
    hover = (shadow.time > 10.0) & (shadow.time < 12.0)
    felt = np.mean(shadow["disturbance_force"][hover, 2] - flown["disturbance_force"][: len(shadow.time)][hover, 2])
    assert felt == pytest.approx(share * weight, rel=0.1)


def test_a_pilot_that_is_told_the_truth_reads_the_log_for_it():
    mission = tl.load_mission("flight-ready", {"mission.duration": 16.0, "mission.log_interval": 0.001})
    flight = tl.fly(mission)
    streams = {
        name: Stream(flight.time, flight[name.removeprefix("measured_")]) for name in (*MOTION, "measured_rates")
    }
    turning = streams["measured_rates"].values + 1e-30 * np.arange(len(flight.time))[:, None]  # no channel is dead
    streams |= {"push_force": Stream(flight.time, flight["push_force"])}
    streams |= {"measured_rates": Stream(flight.time, turning)}
    shadow = tl.shadow(Log(streams), mission)
    assert np.abs(shadow["rotor_thrusts"] - flight["rotor_thrusts"]).max() < 1e-9
    with pytest.raises(tl.InputError, match="has no push_force"):
        tl.shadow(without(Log(streams), "push_force"), mission)


def in_g(log):
    time, values = log["measured_specific_force"]
    return replace(log, streams={**log.streams, "measured_specific_force": Stream(time, values / 9.81)})


@pytest.mark.parametrize(
    ("change", "mission", "message"),
    [
        (lambda log: without(log, "measured_joint_torque"), {}, "has no measured_joint_torque .torque reading"),
        (lambda log: log, {"initial.position": [1.0, 0.0, 0.03]}, r"begins at .* set initial\.position"),
        (lambda log: log, {"changes": [{"time": 1.0, "key": "admittance.mass", "value": 2.0}]}, "changes in flight"),
        (lambda log: log.between(-1.0, 0.0005), {}, "before the first step"),
        (lambda log: log.between(9.0, 12.0), {}, r"begins at 9 s, .* shift it by log\.aligned\(\[\*log\], -9\)"),
        (in_g, {}, r'seems to be in g: \[measured_specific_force\] unit = "g"'),
    ],
)
def test_what_cannot_be_the_log_of_the_mission_is_refused(log, change, mission, message):
    with pytest.raises(tl.InputError, match=message):
        tl.shadow(change(log), iris(**mission))


def test_a_log_with_fewer_samples_than_the_mission_takes_is_warned_of(log):
    sparse = log.mapped(lambda name, stream: Stream(stream.time[::4], stream.values[::4])).between(-1.0, 2.0)
    with pytest.warns(tl.FlightWarning, match=r"measured_rates at 250 Hz, .* at 1000 Hz.*set sensors.interval = 0.004"):
        tl.shadow(sparse, iris())


def test_a_stream_that_begins_late_is_warned_of(log):
    time, values = log["measured_joint_force"]
    late = replace(log, streams={**log.streams, "measured_joint_force": Stream(time[2000:], values[2000:])})
    with pytest.warns(tl.FlightWarning, match=r"begins late: measured_joint_force at .* the first sample is held"):
        tl.shadow(late.between(-1.0, 3.0), iris())


def test_a_vehicle_of_more_quadrotors_is_refused(log):
    with pytest.raises(tl.InputError, match="has 6 columns: must be 3 for each of the 4 quadrotors of mission four"):
        tl.shadow(log, tl.load_mission("four", {"sensors.model": "simulated"}))
