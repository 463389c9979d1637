"""One step of what clients command: attitudes against SciPy's rotations, loops against their closed forms."""

import math
import struct
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tandemlift.apps.clients import flight as flights
from tandemlift.apps.clients import setpoints as sp
from tandemlift.apps.clients.cascade import GRAVITY, MAX_SPEED, MAX_TILT, Demand, InnerLoops, OuterLoops, gains_for
from tandemlift.apps.clients.crazyflie.device import Crazyflie
from tandemlift.apps.clients.crazyflie.high_level import HighLevelCommander
from tandemlift.apps.clients.crazyflie.server import CrazyflieServer
from tandemlift.apps.clients.crazyflie.tables import NO_ENTRY, CrtpParameter, ParameterService
from tandemlift.apps.clients.one_body import LoopGroup, tilt, together
from tandemlift.apps.clients.quadrotors import LEVELLING_TIME, SHUTDOWN_TIME, ArmingState, Quadrotors
from tandemlift.missions import load_mission

STEP = 1e-3
AT_REST = np.array([0.0, 0.0, 1.0, *[0.0] * 3, 1.0, *[0.0] * 6])


def vehicle():
    return load_mission("crazyflie-stick").hover.vehicle


def quaternion(rotation):
    x, y, z, w = rotation.as_quat()
    return w, x, y, z


def state(rotation=None, **more):
    q = quaternion(rotation or Rotation.identity())
    zero = (0.0, 0.0, 0.0)
    fields = {"time": 0.0, "position": zero, "velocity": zero, "quaternion": q, "rates": zero}
    return sp.QuadrotorState(**{**fields, "specific_force": zero, "thrusts": (0.0,) * 4, **more})


# attitudes


@pytest.mark.parametrize("angles", [(0.3, -0.7, 2.0), (-1.2, 0.4, -3.0), (2.5, 1.1, 0.5)])
def test_euler_angles_and_tilt_are_those_of_scipy(angles):
    rotation = Rotation.from_euler("ZYX", angles[::-1])
    assert sp.euler_of(quaternion(rotation)) == pytest.approx(angles)
    assert tilt(quaternion(rotation)) == pytest.approx(math.acos(rotation.as_matrix()[2, 2]))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_nose_straight_down_or_up_is_a_right_angle_also_if_its_quaternion_is_rounded_up(sign):
    half = math.sqrt(0.5) + 1e-16
    assert 2.0 * half * half > 1.0
    assert sp.euler_of((half, 0.0, sign * half, 0.0))[1] == pytest.approx(sign * math.pi / 2.0)


def test_an_estimate_is_turned_about_body_axes_by_its_small_error_and_stays_a_unit():
    true, error = Rotation.from_euler("ZYX", (0.8, -0.4, 0.3)), np.array([0.02, -0.03, 0.01])
    found = sp.EstimateError(tuple(error), (0.1, 0.2, 0.3), (1.0, 2.0, 3.0)).of(
        state(true, rates=(1.0, 1.0, 1.0), position=(1.0, 1.0, 1.0))
    )
    w, x, y, z = found.quaternion
    assert w * w + x * x + y * y + z * z == pytest.approx(1.0)
    turned = (true.inv() * Rotation.from_quat([x, y, z, w])).as_rotvec()
    assert turned == pytest.approx(error, rel=1e-3)
    assert (found.rates, found.position) == (pytest.approx((1.1, 1.2, 1.3)), pytest.approx((2.0, 3.0, 4.0)))


def test_a_setpoint_with_one_number_that_is_none_is_not_finite():
    for setpoint in (
        sp.PositionSetpoint((0.0, math.nan, 0.0)),
        sp.AttitudeSetpoint(0.0, 0.0, math.inf),
        sp.VelocitySetpoint((0.0, 0.0, 0.0), yaw=math.nan),
    ):
        assert not sp.is_finite(setpoint)
    assert sp.is_finite(sp.VelocitySetpoint((1.0, 0.0, 0.0)))


# loops


@pytest.mark.parametrize(("far", "speed"), [(100.0, MAX_SPEED), (0.05, None)])
@pytest.mark.parametrize("yaw", [0.0, 1.1])
def test_a_target_is_approached_in_proportion_and_no_faster_than_allowed_whatever_the_heading(far, speed, yaw):
    gains = gains_for(0.05)
    outer, place = OuterLoops(gains, 2.0, 100.0), np.array([0.6, -0.8, 0.0])
    now = state(Rotation.from_euler("Z", yaw))
    demand = outer.demand(now, sp.PositionSetpoint(tuple(far * place), yaw), 1e-9)
    asked = gains.velocity * (speed or gains.position * far) * place[:2]
    ahead = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]]) @ asked
    assert (demand.pitch, demand.roll) == pytest.approx(
        (
            np.clip(math.atan(ahead[0] / GRAVITY), -MAX_TILT, MAX_TILT),
            np.clip(-math.atan(ahead[1] / GRAVITY), -MAX_TILT, MAX_TILT),
        )
    )
    assert (demand.thrust, demand.yaw, demand.target) == (pytest.approx(2.0 * GRAVITY), yaw, tuple(far * place))


def test_a_steady_error_of_speed_grows_the_integral_by_its_share():
    gains = gains_for(0.05)
    outer = OuterLoops(gains, 2.0, 100.0)
    for _ in range(10):
        outer.demand(state(velocity=(0.1, 0.0, -0.2)), sp.VelocitySetpoint((0.0, 0.0, 0.0)), 0.01)
    assert outer.integral == pytest.approx((-0.04 * gains.velocity * 0.1 * 0.1, 0.0, 0.6 * gains.climb * 0.2 * 0.1))


def inner():
    return InnerLoops(gains_for(0.05), (0.02, 0.03, 0.05), (3.0, 3.0, 1.0))


def test_the_moment_turns_up_the_missing_rate_by_the_inertia():
    loops, wanted = inner(), np.array([0.01, -0.02, 0.03])
    moment = loops.moment(state(), Demand(1.0, rates=tuple(wanted)), 1e-9)
    assert moment == pytest.approx(np.array(loops.rate_gains) * (0.02, 0.03, 0.05) * wanted)


@pytest.mark.parametrize("angles", [(0.3, -0.5, 0.2), (-0.4, 0.6, 1.5)])
def test_a_missing_yaw_asks_for_the_body_rates_of_a_turn_about_the_vertical(angles):
    """The rates of the body that turns about world z: Rᵀ (0, 0, ψ̇)."""
    rotation, loops = Rotation.from_euler("ZYX", angles[::-1]), inner()
    rates = loops._rates(state(rotation), Demand(1.0, angles[0], angles[1], angles[2] + 0.01), 1e-9)
    along = rotation.inv().apply([0.0, 0.0, 0.01 * loops.attitude_gains[2]])
    assert rates == pytest.approx(along)
    up = loops._rates(state(), Demand(1.0, 0.004, 0.0, 0.0), 1e-9)
    assert up == pytest.approx((0.004 * loops.attitude_gains[0], 0.0, 0.0), abs=1e-9)


def test_demands_on_one_body_are_all_thrusts_and_the_mean_attitude():
    arms = [(0.0, 0.25, 0.0), (0.0, -0.25, 0.0)]
    both = together([Demand(2.0, 0.1, 0.2, 3.1), Demand(3.0, 0.3, 0.4, -3.1)], arms)
    assert (both.thrust, both.roll, both.pitch) == pytest.approx((5.0, 0.2, 0.3))
    assert abs(both.yaw) == pytest.approx(math.pi)
    rates = together([Demand(2.0, rates=(1.0, 2.0, 3.0)), Demand(3.0, rates=(3.0, 0.0, 1.0))], arms)
    assert rates.rates == pytest.approx((2.0, 1.0, 2.0))


def test_thrusts_of_those_that_turn_make_the_wrench_and_others_stand():
    body = vehicle()
    group = LoopGroup(body, gains_for(0.05), range(2), max(q.thrust_limit for q in body.quadrotors))
    most, weight = np.repeat([q.thrust_limit for q in body.quadrotors], 4), body.weight
    wrench = np.array([weight, 0.0, 1e-4, 1e-5])
    thrusts = group.thrusts(wrench, (True, True), most)
    assert body.effect @ thrusts == pytest.approx(wrench, abs=1e-9)
    one = group.thrusts((0.2 * weight, 0.0, 0.0, 0.0), (True, False), most)
    assert not one[4:].any()
    assert one[:4].sum() > 0.0


# quadrotors


def quadrotors(control="shared"):
    found = Quadrotors(vehicle(), 0.05, STEP, control)
    assert found.now == 0.0
    found.update(0.0, AT_REST)
    for i in range(2):
        assert found.arm(i)
    return found


def test_the_state_of_each_is_that_of_its_place_on_the_turning_body():
    body, quads = vehicle(), Quadrotors(vehicle(), 0.05, STEP)
    rotation, position = Rotation.from_euler("ZYX", (0.5, 0.1, -0.2)), np.array([1.0, 2.0, 3.0])
    velocity, rates = np.array([0.3, 0.2, 0.1]), np.array([0.4, -0.3, 0.6])
    quads.update(0.0, [*position, *velocity, *quaternion(rotation), *rates])
    for i, arm in enumerate(body.lever_arms):
        one = quads.state(i)
        assert one.position == pytest.approx(position + rotation.apply(arm))
        assert one.velocity == pytest.approx(velocity + rotation.apply(np.cross(rates, arm)))
        assert (one.quaternion, one.rates) == (pytest.approx(quaternion(rotation)), pytest.approx(rates))
        assert one.specific_force == pytest.approx(rotation.inv().apply([0.0, 0.0, GRAVITY]))


@pytest.mark.thorough
def test_a_setpoint_is_flown_until_it_is_old_then_the_quadrotor_levels_out_and_stops():
    quads, weight = quadrotors(), vehicle().weight
    for i in range(2):
        quads.command(i, sp.AttitudeSetpoint(0.0, 0.0, 0.3 * weight))
    k, seen = 0, {}
    for age in (0.9 * LEVELLING_TIME, 1.1 * LEVELLING_TIME, 0.9 * SHUTDOWN_TIME, 1.1 * SHUTDOWN_TIME):
        while (k + 1) * STEP <= age:
            k += 1
            thrusts = quads.update(k * STEP, AT_REST)
        seen[age] = (quads.supervision[0], float(thrusts.sum()) > 0.0, quads.is_flying(0))
    assert list(seen.values()) == [
        (ArmingState.ARMED, True, True),
        (ArmingState.WARNING, True, True),
        (ArmingState.WARNING, True, True),
        (ArmingState.LOCKED, False, False),
    ]


def test_a_quadrotor_without_a_setpoint_is_carried_by_the_same_thrust():
    quads, weight = quadrotors(), vehicle().weight
    quads.command(0, sp.AttitudeSetpoint(0.0, 0.0, 0.4 * weight, yaw=0.0))
    for k in range(1, 9):
        thrusts = quads.update(k * STEP, AT_REST)
    assert thrusts.sum() == pytest.approx(2.0 * 0.4 * weight)
    assert quads.is_flying(0)
    assert quads.is_flying(1)


@pytest.mark.thorough
@pytest.mark.parametrize(("share", "flies"), [(0.04, False), (0.06, True)])
def test_a_twentieth_of_the_weight_is_a_flight(share, flies):
    quads = quadrotors()
    for i in range(2):
        quads.command(i, sp.AttitudeSetpoint(0.0, 0.0, 0.5 * share * vehicle().weight, yaw=0.0))
    for k in range(1, 5):
        quads.update(k * STEP, AT_REST)
    assert [quads.is_flying(i) for i in range(2)] == [flies] * 2


# a Crazyflie


def header(port, channel):
    return bytes([port << 4 | 0x0C | channel])


def test_a_packet_is_of_the_channel_in_its_lowest_two_bits():
    device = Crazyflie(quadrotors(), 0)
    assert device.receive(header(15, 1) + b"\0")[0][1:].startswith(b"Bitcraze Crazyflie")
    assert device.receive(header(15, 0) + b"abc") == [header(15, 0) + b"abc"]
    (crc,) = device.receive(header(5, 0) + b"\x03")
    assert struct.unpack("<BHI", crc[1:])[1] == len(device.log.table)


def test_it_logs_what_the_firmware_does_with_a_nose_up_as_a_positive_pitch():
    quads = quadrotors()
    rotation = Rotation.from_euler("ZYX", (0.5, 0.2, -0.1))
    device = Crazyflie(quads, 0)
    read = {name: value for name, (_, value) in device._variables().items()}
    quads.command(0, sp.AttitudeSetpoint(-0.1, 0.2, 0.4 * vehicle().weight, yaw=0.5))
    for k in range(1, 9):
        quads.update(k * STEP, [0.0, 0.0, 1.0, *[0.0] * 3, *quaternion(rotation), *[0.0] * 3])
    assert read["stabilizer.pitch"]() == pytest.approx(-math.degrees(0.2))
    assert read["stabilizer.roll"]() == pytest.approx(math.degrees(-0.1))
    assert read["stateEstimate.yaw"]() == pytest.approx(math.degrees(0.5))
    assert read["acc.z"]() == pytest.approx(rotation.as_matrix()[2, 2])
    thrusts, full = quads.state(0).thrusts, vehicle().quadrotors[0].thrust_limit
    for n in range(4):
        assert read[f"motor.m{n + 1}"]() == pytest.approx(65535.0 * thrusts[n] / full)
    assert max(thrusts) > 0.0


def test_a_parameter_behind_the_last_is_no_entry_and_one_that_is_read_has_its_number_first():
    service = ParameterService({"a.b": CrtpParameter("B", 7), "c.d": CrtpParameter("H", 300)})
    assert service.answer(1, b"\x01\x00") == b"\x01\x00\x00" + struct.pack("<H", 300)
    assert service.answer(1, b"\x00\x00") == b"\x00\x00\x00\x07"
    assert service.answer(1, b"\x02\x00") == b"\x02\x00" + bytes([NO_ENTRY])
    assert service.answer(2, b"\x00\x00\x09") == b"\x00\x00\x09"
    assert service.answer(3, b"\x08\x02\x00") == b"\x08\x02\x00" + bytes([NO_ENTRY])


def test_a_stop_is_carried_out_and_said_to_be():
    commander = HighLevelCommander()
    assert commander.command(b"\x03\x00", state()) == 0
    assert commander.setpoint(0.0) == sp.Stop()


def test_without_a_port_each_listens_at_one_of_its_own():
    with CrazyflieServer(quadrotors(), port=0) as server:
        ports = [int(address.rpartition(":")[2]) for address in server.addresses]
    assert len(set(ports)) == 2
    assert all(port > 1023 for port in ports)


# a flight in real time


def test_a_flight_in_real_time_takes_the_thrusts_of_all_rotors_at_its_time(monkeypatch):
    seen, body = [], np.arange(13.0)

    def update(time, numbers):
        seen.append((time, list(numbers)))
        return np.full(8, 0.5)

    session = SimpleNamespace(prepare=lambda: None, flight=SimpleNamespace(layout=None))
    monkeypatch.setattr(flights, "check_stands", lambda mission: None)
    monkeypatch.setattr(flights, "Session", lambda *given: setattr(session, "given", given) or session)
    spans = {"position": (0, 3), "velocity": (3, 6), "attitude": (6, 10), "rates": (10, 13)}
    places = {name: np.arange(*span) + 2 for name, span in spans.items()}
    monkeypatch.setattr(flights, "channel_columns", lambda layout, none: places)
    one = flights.RealTimeFlight(None, SimpleNamespace(count=2, update=update), "engine", None)
    inputs = one._commanded(SimpleNamespace(sample=np.concatenate([[-1.0, -1.0], body]), step=30, dt=0.002))
    assert seen == [(0.06, body.tolist())]
    assert inputs[6:14].tolist() == [0.5] * 8
    assert inputs[14] == 1.0  # they count
    assert len(inputs) == 6 + 8 + 1 + 4
    assert not inputs[[*range(6), *range(15, 19)]].any()
