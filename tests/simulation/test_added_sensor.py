"""The recipe "Add a sensor" of CONTRIBUTING.md: a row and a law, here a barometer's, and missions fly with it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.errors import InputError
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY
from tandemlift.flight.channels import CHANNELS
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.health import PerSensor
from tandemlift.parts.sensors.readings import ImuChannels, ImuReading, MotionChannels, MotionReading, Readings
from tandemlift.parts.sensors.sensor_registry import register_sensor
from tandemlift.parts.sensors.vehicle_sensors import DEVICES, SENSORS, additional, sensors_on

SEA_LEVEL, DENSITY = 101325.0, 1.225  # Pa, kg/m³
STEP = 1e-3
BAROMETER = additional("barometer", "Pa", "static air pressure at the centre of mass")


@register_sensor(BAROMETER)
@law
def air_pressure(sensor: Any, state: State, perfect: PerfectReadings) -> Any:
    """The static pressure at the height of the centre of mass [Pa], in air of constant density."""
    return SEA_LEVEL - state.position.z * (DENSITY * GRAVITY)


def changes(seed: int = 0, duration: float = 0.5, name: str = "barometer", **settings: Any) -> dict[str, Any]:
    """Of mission `paper`: it sinks from 0.5 m with simulated sensors and an additional one, logged at every step."""
    return {
        "mission.duration": duration,
        "mission.log_interval": STEP,
        "mission.step": STEP,
        "mission.seed": seed,
        "initial.position": [0.0, 0.0, 0.5],
        "sensors.model": "simulated",
        "sensors.additional": [{"name": name, **settings}],
    }


def mission(*args: Any, **settings: Any) -> tl.Mission:
    """The mission with these changes."""
    return tl.load_mission("paper", changes(*args, **settings))


def pressure(flight: tl.Flight) -> np.ndarray:
    """The true pressure at every step [Pa]."""
    return SEA_LEVEL - DENSITY * GRAVITY * flight["position"][:, 2]


def errors(flight: tl.Flight) -> np.ndarray:
    """What the barometer read too much [Pa]; a sample is known one step later."""
    return flight["measured_barometer"][1:] - pressure(flight)[:-1]


def deviation_is(values: Any, sigma: float) -> bool:
    """Whether values around 0 have that standard deviation, but for 1 in 5,000."""
    low, high = stats.chi2.ppf([1e-4, 1.0 - 1e-4], np.size(values))
    return bool(low < np.sum(np.square(values)) / sigma**2 < high)


def test_a_perfect_sensor_reads_what_its_law_gives_one_step_later_in_a_channel_as_its_row_says(tmp_path):
    flight = tl.fly(mission())
    assert np.ptp(pressure(flight)) > 0.1  # Pa
    assert errors(flight) == pytest.approx(0.0, abs=1e-10)
    info = flight.info("measured_barometer")
    assert (info.unit, info.frame) == ("Pa", "")
    assert BAROMETER.meaning in info.meaning
    assert tl.Flight.load(flight.save(tmp_path / "flight.npz"))["measured_barometer"].shape == (501,)


def test_the_delay_is_the_one_that_is_set_and_another_sensors_is_not_changed():
    steps = 50
    flight = tl.fly(mission(delay=steps * STEP))
    read, true = flight["measured_barometer"], pressure(flight)
    assert read[1 + steps :] == pytest.approx(true[: -1 - steps], abs=1e-10)
    assert read[: 1 + steps] == pytest.approx(true[0], abs=1e-10)
    assert np.array_equal(flight["measured_position"][1:], flight["position"][:-1])


def test_it_reads_whole_steps_and_no_more_than_its_range():
    assert np.unique(tl.fly(mission(resolution=2.5, noise=3.0))["measured_barometer"] / 2.5 % 1.0) == [0.0]
    assert np.unique(tl.fly(mission(range=90000.0))["measured_barometer"]) == [90000.0]


@pytest.mark.parametrize("kind", ["frozen", "bias", "range", "nan", "stale"])
def test_it_fails_as_any_sensor_does(kind):
    fault = {"sensor": "barometer", "kind": kind, "time": 0.2, "until": 0.3, "size": 7.0}
    flight = tl.fly(tl.load_mission("paper", {**changes(), "sensor_faults": [fault]}))
    read, true = flight["measured_barometer"], np.concatenate([[pressure(flight)[0]], pressure(flight)[:-1]])
    failed = slice(201, 301)
    expected = {
        "frozen": np.full(100, true[200]),
        "stale": np.full(100, true[200]),
        "bias": true[failed] + 7.0,
        "range": np.full(100, 7.0),
        "nan": np.full(100, np.nan),
    }[kind]
    assert read[failed] == pytest.approx(expected, abs=1e-10, nan_ok=True)
    for sound in (slice(1, 201), slice(301, None)):
        assert read[sound] == pytest.approx(true[sound], abs=1e-10)


def test_a_vector_is_read_in_its_frame_with_noise_on_each_axis():
    flight = tl.fly(mission(name="magnetometer", noise=0.01, duration=2.0))
    north = Rotation.from_quat(flight["attitude"], scalar_first=True).inv().apply([1.0, 0.0, 0.0])
    off = flight["measured_magnetometer"][1:] - north[:-1]
    assert all(deviation_is(axis, 0.01) for axis in off.T)
    assert flight.info("measured_magnetometer").frame == "body"


def test_it_changes_no_bit_of_any_other_channel():
    with_it = tl.fly(mission(noise=1.0, bias=3.0))
    without = tl.fly(tl.load_mission("paper", {**changes(), "sensors.additional": []}))
    assert set(with_it) - set(without) == {"measured_barometer", "barometer_stamp"}
    assert all(np.array_equal(without[name], with_it[name]) for name in without)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (
            {"sensors.additional": [{"name": "barometr"}]},
            r'additional\.0\.name = "barometr": must be one of .*barometer',
        ),
        ({"sensors.additional": [{"name": "barometer"}] * 2}, "must be different from the sensors above"),
        ({"sensors.model": "none"}, r'sensors\.model = "none": must be "simulated"'),
        ({"sensor_faults": [{"sensor": "altimeter", "kind": "nan", "time": 0.1}]}, 'sensor = "altimeter": must be one'),
        ({"sensor_faults": [{"sensor": "barometer", "kind": "nan", "time": 0.1, "quadrotor": 1}]}, "must be left out"),
    ],
)
def test_a_mission_that_cannot_have_it_is_refused(wrong, words):
    with pytest.raises(InputError, match=words):
        tl.load_mission("paper", {**changes(), **wrong})


def test_a_name_that_is_taken_or_unfit_and_a_law_of_another_width_than_its_row_are_refused():
    for name in ("gyroscope", "imu", "specific_force", "Baro Meter", ""):
        with pytest.raises(InputError, match="cannot be named"):
            register_sensor(additional(name, "1", "nothing"))(air_pressure)
    with pytest.raises(InputError, match="a number for width 1, a Vec3 for 3, not float"):
        register_sensor(additional("wide", "Pa", "pressure", width=3))(air_pressure)


def test_the_table_names_every_sensor_once_and_its_units_are_those_of_the_channels():
    assert PerSensor._fields == tuple(SENSORS)
    assert Readings._fields[:2] == DEVICES
    for device, channels, reading in zip(
        DEVICES, (ImuChannels, MotionChannels), (ImuReading, MotionReading), strict=True
    ):
        quantities = {name for sensor in sensors_on(device) for name in sensor.quantities}
        assert quantities == set(channels._fields) - {"frame"}
        assert reading._fields == (*channels._fields, "fresh")
    for sensor in SENSORS.values():
        channel = CHANNELS[f"measured_{sensor.quantities[0]}"]
        assert (sensor.unit, sensor.frame) == (channel.unit, channel.frame)
