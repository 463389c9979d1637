"""Identification from flawed logs: pushes that nothing measured, silent sensors, gaps, other origins; and missions."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.identification.identification import Identification, Row, with_values
from tandemlift.analysis.identification.identify import reference_rows
from tandemlift.analysis.identification.windows import windows_of
from tandemlift.analysis.logs.log import JOINTS, MOTION, PUSH, SPEED_COMMANDS, Log, Stream, log_of
from tandemlift.core.errors import InputError
from tandemlift.engines.driven_vehicle import effect_floor
from tandemlift.missions import load_mission

START = "iris"
TRUTH = {
    "vehicle.payload.mass": 0.62,
    "vehicle.payload.center_of_mass": [0.0, 0.05, 0.0],
    "actuators.delay": 0.013,
    "vehicle.quadrotors.0.mass": 1.6,
}
EXCITED = (("thrust", 0.5), ("roll", 0.3), ("pitch", 0.03), ("yaw", 0.06))
FLOWN = {
    "mission.duration": 34.0,
    "mission.log_interval": 0.001,
    "phases.land_start": 90.0,
    "pushes": [],
    "excitation.model": "multisine",
    "excitation.begin": 13.0,
    "excitation.duration": 21.0,
    "excitation.lines": [
        {"axis": axis, "frequency": f, "amplitude": size, "phase": 0.7 * k * k}
        for axis, size in EXCITED
        for k, f in enumerate((0.35, 0.6, 1.0, 1.7, 2.9, 4.9, 8.0))
    ],
}
PUSHES = [  # of five, between which hardly a window is calm
    {"force": force, "time": time, "sigma": 0.4}
    for force, time in (
        ([3.0, 0.0, 0.0], 16.0),
        ([0.0, 3.0, 0.0], 20.0),
        ([-3.0, 0.0, 0.0], 24.0),
        ([0.0, -3.0, 0.0], 28.0),
        ([2.0, 0.0, 0.0], 32.0),
    )
]
ONE = {"force": [3.0, 3.0, 2.0], "time": 22.5, "sigma": 0.4}
pytestmark = [pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning"), pytest.mark.thorough]


def flown(*pushes):
    """The log of a flight under pushes, without what only a simulation knows."""
    log = log_of(tl.fly(load_mission(START, TRUTH | FLOWN | {"pushes": pushes})))
    kept = {name: stream for name, stream in log.items() if name not in (*PUSH, "rotor_commands")}
    return Log(kept, "flawed", stamp_offset=log.stamp_offset)


def changed(log, **streams):
    return Log({**log, **streams}, "changed", stamp_offset=log.stamp_offset)


def identified(log, mission=START, **options):
    weighed = {"vehicle.payload.mass": TRUTH["vehicle.payload.mass"]}
    return tl.identify(log, mission, weighed=weighed, progress=lambda done, of: None, **options)


def refused(log, *parts, mission=START, **options):
    with pytest.raises(InputError) as error:
        identified(log, mission, **options)
    assert all(part in str(error.value) for part in parts), error.value


def errors(found):
    """Errors over the standard deviations of the intervals, by key."""
    truth = reference_rows(load_mission(START, TRUTH))
    return {r.key: abs(r.value - truth[r.key]) / r.half * 1.96 for r in (*found.rows, *found.whole) if r.excited}


@pytest.fixture(scope="module")
def log():
    return flown()


@pytest.fixture(scope="module")
def pushed():
    return flown(ONE)


def test_more_pushes_than_half_a_log_has_windows_for_leave_it_the_calm_ones():
    found = identified(flown(*PUSHES))
    assert found.details["windows"] == {"used": 8, "left_out": 15}
    assert max(errors(found).values()) < 2.5
    assert any("more than half of the windows" in text for text in found.remarks)


def test_joints_that_are_silent_in_most_windows_hide_no_push(pushed):
    heard = {}
    for name in JOINTS:
        time, values = pushed[name]
        there = (time < 14.5) | (time > 29.0)
        heard[name] = Stream(time[there], values[there])
    found = identified(changed(pushed, **heard))
    assert 2 <= found.details["windows"]["left_out"] <= 6
    assert max(errors(found).values()) < 3.0
    assert not any("more than half of the windows" in text for text in found.remarks)


def test_one_push_does_not_throw_the_search_off(pushed):
    found = identified(pushed)
    assert 2 <= found.details["windows"]["left_out"] <= 6
    assert max(errors(found).values()) < 2.5
    assert not any("not white" in text for text in found.remarks)


def test_windows_after_a_gap_of_the_commands_wait_until_the_rotors_have_settled(log):
    time, speeds = log[SPEED_COMMANDS]
    whole = windows_of(log, load_mission(START)).times()
    gaps = whole[[3, 9, 15]] + [0.4, -0.35, 0.95]  # in a window, before one, at the end of one
    known = ~np.any((time > gaps[:, None]) & (time < gaps[:, None] + 0.02), axis=0)
    left = windows_of(changed(log, **{SPEED_COMMANDS: Stream(time[known], speeds[known])}), load_mission(START)).times()
    assert np.setdiff1d(whole.round(6), left.round(6)) == pytest.approx(whole[[3, 8, 9, 15, 16]], abs=1e-5)


def test_the_floor_of_the_ground_effect_is_the_logs_own(log):
    mission, (time, position) = load_mission(START), log[MOTION[0]]
    lower = changed(log, **{MOTION[0]: Stream(time, position - [0.0, 0.0, 1.2])})
    floor = windows_of(log, mission).floor
    assert floor == effect_floor(mission)[0]
    assert windows_of(lower, mission).floor == pytest.approx(floor - 1.2)
    assert windows_of(log.between(14.0, 34.0), mission).floor == floor
    assert windows_of(lower.between(14.0, 34.0), mission).floor is None  # nothing tells where it is


def test_samples_that_a_table_holds_for_several_rows_count_once(log):
    time, mission = log["measured_rates"].time, load_mission(START)
    table = changed(log, **{name: Stream(time, log[name].at(time)) for name in MOTION})
    held, plain = windows_of(table, mission), windows_of(log, mission)
    for name in MOTION:
        assert np.array_equal(held.samples[name].values, plain.samples[name].values)
        assert np.array_equal(held.samples[name].step, plain.samples[name].step)
    assert "measured_position (80%), measured_velocity (80%), measured_attitude (80%)" in held.notes[0]
    assert not plain.notes


def test_moments_and_products_of_inertia_are_set_together_and_what_fails_has_no_interval():
    thin = {"shape": "beam", "mass": 0.5, "inertia": [0.0835, 0.0835, 0.1667], "products": [-0.083, 0.0, 0.0]}
    found = {"inertia": [0.0752, 0.0752, 0.15], "products": [-0.0747, 0.0, 0.0]}  # no body with the old products
    values = {f"vehicle.payload.{name}": value for name, value in found.items()} | {"actuators.delay": [-1.0]}
    mission, failed = with_values(load_mission(START, {"vehicle.payload": thin}), values)
    assert list(mission.vehicle.payload.inertia) == found["inertia"]
    assert list(mission.vehicle.payload.products) == found["products"]
    assert list(failed) == ["actuators.delay"]
    keys = "actuators.delay", "vehicle.payload.inertia.x"
    rows = tuple(Row(key, 0.1, 0.0, 0.2, "", 0.1, True, 1.0) for key in keys)
    lines = Identification(mission, rows, (), (), {"refused": [*failed]}).toml().splitlines()
    assert [line.partition(" ")[0] for line in lines if "±" in line] == ["inertia"]


def test_a_payload_of_bodies_has_no_place_for_its_numbers(log):
    payload = {"shape": "bodies", "bodies": [{"mass": 0.5, "ends": [[0, -1, 0], [0, 1, 0]], "radius": 0.03}]}
    refused(
        log, 'shape = "bodies" gives vehicle.payload.mass', mission=load_mission(START, {"vehicle.payload": payload})
    )


def test_a_positive_number_cannot_start_from_0(log):
    no_lag = load_mission(START, {f"vehicle.quadrotors.{i}.lag_up": 0.0 for i in (0, 1)})
    refused(log, "vehicle.quadrotors.*.lag_up = 0: must start above 0", mission=no_lag)


def test_speeds_above_those_of_the_mission_are_not_cut_off(log):
    time, speeds = log[SPEED_COMMANDS]
    faster = changed(log, **{SPEED_COMMANDS: Stream(time, 1.35 * speeds)})  # thrusts 1.8 times as large may be
    refused(faster, "max_speed = 1100 rad/s", f"reach {1.35 * speeds[:, :4].max():.5g} rad/s: set max_speed")
    twice = changed(log, **{SPEED_COMMANDS: Stream(time, 1.6 * speeds)})
    refused(twice, "rotor_speed_commands: hover: 2.", "of the weight; expected: 0.5 to 2")


def test_a_stream_that_ends_early_takes_no_windows_of_the_others(log):
    mission, whole = load_mission(START), windows_of(log, load_mission(START))
    short = dict(log)
    for name in JOINTS:
        time, values = log[name]
        short[name] = Stream(time[time < 20.0], values[time < 20.0])
    cut = windows_of(Log(short, "short", stamp_offset=log.stamp_offset), mission)
    assert np.array_equal(cut.times(), whole.times())
    assert "measured_joint_force at 20 s, measured_joint_torque at 20 s" in cut.notes[0]
    assert not whole.notes


def test_a_weighed_mass_must_be_among_the_parameters(log):
    refused(log, "weighed vehicle.payload.mass: no mass is among", parameters=["vehicle.quadrotors.*.lag_up"])
