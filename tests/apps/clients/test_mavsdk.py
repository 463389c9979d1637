"""Scripts from MAVSDK's documentation, by the unmodified mavsdk 4.1.0, against `tandemlift mavlink two-x500`."""

import asyncio
import importlib.metadata
import random
import subprocess
import sys
import time

import pytest
from patience import COMPILING, PATIENCE, ended

pytestmark = pytest.mark.clients
TAKEOFF = 1.5  # m
HOVER = 4.728 * 9.81 / (8 * 8.54858)  # of the largest thrust: 4.728 kg on eight rotors of 8.55 N


@pytest.fixture(scope="module")
def ports(tmp_path_factory):
    """The ports of the clients of both quadrotors, which the command flies."""
    assert importlib.metadata.version("mavsdk") == "4.1.0"
    port = random.SystemRandom().randrange(20000, 60000)
    command = [sys.executable, "-m", "tandemlift", "mavlink", "two-x500", "--udp-port", str(port), "--port", "0"]
    folder = tmp_path_factory.mktemp("flight")
    with subprocess.Popen([*command, "--no-browser"], stdout=subprocess.PIPE, text=True, cwd=folder) as process:
        assert str(port) in process.stdout.readline()
        yield port, port + 1
        assert ended(process) == 0


async def until(holds, ones):
    """Wait until a condition holds for all."""
    end = time.monotonic() + PATIENCE
    while not all([await holds(one) for one in ones]):
        assert time.monotonic() < end, holds.__name__
        await asyncio.sleep(0.1)


def fly(ports, script):
    """Discover both vehicles, take off, run a script for both at once, and land."""
    asyncio.run(asyncio.wait_for(_fly(ports, script), COMPILING))


async def _fly(ports, script):
    from mavsdk.asyncio import ComponentType, Configuration, Mavsdk
    from mavsdk.asyncio.plugins.action import ActionAsync
    from mavsdk.asyncio.plugins.offboard import OffboardAsync
    from mavsdk.asyncio.plugins.telemetry import TelemetryAsync

    async def healthy(t):
        health = await t.health()
        return health.is_local_position_ok and health.is_global_position_ok and health.is_home_position_ok

    async def holds(t):
        height = (await t.position()).relative_altitude_m
        return (await t.flight_mode()).name == "HOLD" and height > TAKEOFF - 0.1

    async def landed(t):
        return not await t.armed() and not await t.in_air()

    async with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as client:
        for port in ports:
            await client.add_any_connection(f"udpin://0.0.0.0:{port}")
        while await client.system_count() < 2:
            await asyncio.sleep(0.1)
        systems = sorted([(await s.get_system_id(), s) for s in await client.get_systems()])
        assert [number for number, _ in systems] == [1, 2]
        action = [ActionAsync(s) for _, s in systems]
        telemetry = [TelemetryAsync(s) for _, s in systems]
        offboard = [OffboardAsync(s) for _, s in systems]
        await until(healthy, telemetry)
        await until(landed, telemetry)  # also where an earlier client has vanished in flight
        await asyncio.gather(*(a.arm() for a in action))
        for a in action:
            await a.set_takeoff_altitude(TAKEOFF)
        await asyncio.gather(*(a.takeoff() for a in action))
        await until(holds, telemetry)
        await script(systems, offboard, telemetry)
        await asyncio.gather(*(a.land() for a in action))
        await until(landed, telemetry)


async def command(offboard, *setpoints):
    """Set each setpoint for both at once; with two of them, begin offboard with the first."""
    for n, setpoint in enumerate(setpoints, 1):
        for o in offboard:
            await getattr(o, NAMES[type(setpoint).__name__])(setpoint)
        if n < len(setpoints):
            await asyncio.gather(*(o.start() for o in offboard))
            await asyncio.sleep(0.5)  # some setpoints are sent


NAMES = {"PositionNedYaw": "set_position_ned", "Attitude": "set_attitude", "AttitudeRate": "set_attitude_rate"}


def test_mavsdk_4_1_0_flies_both_by_position(ports):
    from mavsdk.plugins.offboard import PositionNedYaw

    async def is_there(t):
        place = (await t.position_velocity_ned()).position
        return (place.north_m, place.east_m, place.down_m) == pytest.approx((1.0, 0.0, -2.0), abs=0.05)

    async def script(_, offboard, telemetry):
        await command(offboard, PositionNedYaw(0.0, 0.0, -TAKEOFF, 0.0), PositionNedYaw(1.0, 0.0, -2.0, 0.0))
        await until(is_there, telemetry)
        assert [(await t.battery()).remaining_percent for t in telemetry] == [100.0, 100.0]
        await asyncio.gather(*(o.stop() for o in offboard))

    fly(ports, script)


def test_mavsdk_4_1_0_flies_both_by_attitude(ports):
    from mavsdk.plugins.offboard import Attitude

    async def flies_north(t):
        """Nose down."""
        attitude = await t.attitude_euler()
        return attitude.pitch_deg < -3.0 and abs(attitude.roll_deg) < 1.0 and (await t.velocity_ned()).north_m_s > 0.2

    async def script(_, offboard, telemetry):
        await command(offboard, Attitude(0.0, 0.0, 0.0, HOVER), Attitude(0.0, -5.0, 0.0, HOVER))
        await until(flies_north, telemetry)
        await command(offboard, Attitude(0.0, 0.0, 0.0, HOVER))

    fly(ports, script)


def test_mavsdk_4_1_0_flies_both_by_rates(ports):
    from mavsdk.plugins.offboard import AttitudeRate

    async def has_turned_right(t):
        return (await t.attitude_euler()).yaw_deg > 2.0

    async def script(_, offboard, telemetry):
        await command(offboard, AttitudeRate(0.0, 0.0, 0.0, HOVER), AttitudeRate(0.0, 0.0, 4.0, HOVER))
        await until(has_turned_right, telemetry)
        await command(offboard, AttitudeRate(0.0, 0.0, 0.0, HOVER))

    fly(ports, script)


def test_mavsdk_4_1_0_reads_and_sets_parameters(ports):
    from mavsdk.asyncio.plugins.param import ParamAsync

    async def script(systems, _, __):
        for _, system in systems:
            parameters = ParamAsync(system)
            assert await parameters.get_param_int("COM_OBL_RC_ACT") == 4
            await parameters.set_param_float("COM_OF_LOSS_T", 2.5)
            assert await parameters.get_param_float("COM_OF_LOSS_T") == 2.5
            await parameters.set_param_float("WIND_VELOCITY_1", 0.5)
            assert await parameters.get_param_float("WIND_VELOCITY_1") == 0.5
            everything = await parameters.get_all_params()
            names = {p.name for p in everything.float_params}
            assert {"ADMITTANC_MASS_1", "JOINT_FORCE_1", "MPC_LAND_SPEED"} <= names

    fly(ports, script)


def test_mavsdk_4_1_0_vanishes_in_flight_and_both_land(ports):
    from mavsdk.plugins.offboard import PositionNedYaw

    async def script(_, offboard, __):
        await command(offboard, *[PositionNedYaw(0.0, 0.0, -TAKEOFF, 0.0)] * 2)
        raise KeyError("gone")

    async def nothing(*_):
        pass

    with pytest.raises(KeyError, match="gone"):
        fly(ports, script)
    fly(ports, nothing)  # begins once both have landed by themselves
